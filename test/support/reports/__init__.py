"""Charts for the tests of reports, and the browser that opens the reports."""
