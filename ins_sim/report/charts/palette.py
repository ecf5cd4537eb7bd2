"""The colours of all figures, which the colour-blind can tell apart."""

# Okabe and Ito, "Color Universal Design" (2008), without the yellow, which is pale on white.
BLUE, ORANGE, GREEN, RED = '#0072b2', '#e69f00', '#009e73', '#d55e00'
PURPLE, SKY, BLACK, GREY = '#cc79a7', '#56b4e9', '#000000', '#7f7f7f'
# In the order in which curves take them.
CYCLE = (BLUE, RED, GREEN, PURPLE, ORANGE, SKY, BLACK, GREY)
EAST_NORTH_UP = {'east': RED, 'north': BLUE, 'up': GREEN}
BODY_AXES = {'x': RED, 'y': BLUE, 'z': GREEN}
