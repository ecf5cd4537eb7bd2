"""The style of a report: one column, which fits the width of a telephone, and paper."""

STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; color: #1a1a1a;
  background: #fff; max-width: 1120px; margin: 0 auto; padding: 0 16px 32px;
  overflow-wrap: anywhere; }
h1 { font-size: 1.5em; line-height: 1.25; margin: 24px 0 8px; }
h2 { font-size: 1.15em; margin: 32px 0 8px; }
.answer { font-size: 1.15em; margin: 0 0 8px; padding: 8px 12px; background: #eef4f9;
  border-left: 4px solid #0072b2; white-space: pre-line; }
figure { margin: 0 0 8px; break-inside: avoid; }
.panels { display: grid; grid-template-columns: minmax(0, 1fr); }
.panel { min-width: 0; }
.panel h3 { font-size: 0.95em; margin: 8px 0 0; }
@media (min-width: 800px) {
  .panels.two { grid-template-columns: repeat(2, minmax(0, 1fr)); }
  .panels.three { grid-template-columns: repeat(3, minmax(0, 1fr)); } }
.legend { list-style: none; display: flex; flex-wrap: wrap; gap: 0 16px; margin: 4px 0; padding: 0;
  font-size: 0.85em; }
.legend svg { width: 28px; height: 12px; vertical-align: -1px; margin-right: 6px; }
figcaption { font-size: 0.85em; color: #444; }
img { max-width: 100%; height: auto; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.9em; overflow-wrap: normal; }
th, td { padding: 3px 12px 3px 0; text-align: left; vertical-align: top;
  border-bottom: 1px solid #ddd; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
code { font-size: 0.9em; }
dl { display: grid; grid-template-columns: max-content minmax(0, 1fr); gap: 2px 16px; }
dd { margin: 0; }
@media (max-width: 600px) { th, td { padding-right: 8px; } table { font-size: 0.8em; }
  .settings :is(th, td):last-child { display: none; } }
@media print {
  body { max-width: none; font-size: 11pt; padding: 0; }
  h2 { break-after: avoid; }
  tr { break-inside: avoid; }
  .wide { overflow: visible; } }
"""
