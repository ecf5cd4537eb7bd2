"""What the tests of reports draw, and the browser that opens them."""
