"""The import table of docs/explanation/architecture.md is that of the architecture test."""

import importlib.util

from support.places import ROOT


def drawing():
    """Return the module tools/draw_architecture.py."""
    spec = importlib.util.spec_from_file_location(
        'draw_architecture', ROOT / 'tools' / 'draw_architecture.py')
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_import_table_is_up_to_date():
    """`python tools/draw_architecture.py` would not change the page."""
    tool = drawing()
    page = tool.PAGE.read_text(encoding='utf-8')
    assert tool.with_table(page) == page
    assert '| `core.numerics` | nothing |' in page


def test_the_picture_is_drawn_from_the_boxes(tmp_path):
    """The committed picture holds every box of the script, and the script draws it."""
    tool = drawing()
    tool.draw(tmp_path / 'data_flow.svg')
    committed = tool.PICTURE.read_text(encoding='utf-8')
    drawn = (tmp_path / 'data_flow.svg').read_text(encoding='utf-8')
    for *_, text in tool.BOXES.values():
        for line in text.splitlines():
            assert line in committed and line in drawn
