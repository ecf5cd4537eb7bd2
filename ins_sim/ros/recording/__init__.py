"""Recording live topics into bags, and playing bags."""
