"""Open a report in headless Chromium and measure what it shows, without a browser library."""

from html import unescape
import json
import os
from pathlib import Path
import re
import shutil
import subprocess

import pytest
from support.places import ROOT

NAMES = ('chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable')
# Folder of the screenshots, which are inspected before a release.
SCREENSHOTS = ROOT / 'build' / 'screenshots'
GUARD_S = 300.0
# Inserted before the page: collects its errors, also those that a library only prints.
LISTEN = """<script>
const heard = [];
window.addEventListener('error', event => heard.push(String(event.message)), true);
window.addEventListener('unhandledrejection', event => heard.push(String(event.reason)));
for (const name of ['error', 'warn'])
  console[name] = (...words) => heard.push(words.map(String).join(' '));
</script>"""
# Inserted after the page: measures the figures once they are drawn.
LOOK = """<script>
function canvases(node, found = []) {
  for (const child of node.querySelectorAll('*')) {
    if (child.tagName === 'CANVAS') found.push(child);
    if (child.shadowRoot) canvases(child.shadowRoot, found);
  }
  return found;
}
function colours(canvas) {
  if (!canvas.width || !canvas.height) return 0;
  const pixels = new Uint32Array(canvas.getContext('2d').getImageData(
    0, 0, canvas.width, canvas.height).data.buffer);
  return new Set(pixels).size;
}
function look() {
  const plots = [...document.querySelectorAll('.plot')].map(plot => {
    const box = plot.getBoundingClientRect(), inner = canvases(plot.parentNode);
    return {left: box.left, right: box.right, height: box.height,
            colours: Math.max(0, ...inner.map(colours))};
  });
  const roots = plots.length ? Bokeh.documents[0].roots() : [];
  if (roots.length) roots[0].x_range.setv({start: roots[0].x_range.start + 1.0});
  parent.postMessage(JSON.stringify({
    heard, plots, width: innerWidth, scroll: document.documentElement.scrollWidth,
    images: [...document.images].map(image => [image.naturalWidth,
                                               image.getBoundingClientRect().right]),
    starts: roots.map(root => root.x_range.start),
    legends: [...document.querySelectorAll('.legend li')].map(item => ({
      right: item.getBoundingClientRect().right,
      size: parseFloat(getComputedStyle(item).fontSize), text: item.textContent})),
    loaded: performance.getEntriesByType('resource').map(entry => entry.name)
      .filter(name => !name.startsWith('data:'))}), '*');
}
const wait = setInterval(() => {
  if (typeof Bokeh !== 'undefined' && !Bokeh.documents.every(one => one.is_idle)) return;
  clearInterval(wait);
  setTimeout(look, 500);
}, 50);
</script>"""
# A window of Chromium is never narrower than 500 pixels; therefore the report is shown in a frame
# of the required width.
FRAME = """<!DOCTYPE html><body style="margin: 0; overflow: hidden"><script>
addEventListener('message', event => {{
  const said = document.createElement('pre');
  said.id = 'seen';
  said.textContent = event.data;
  document.body.append(said);
}});
</script><iframe src="seen.html" style="border: 0; width: {}px; height: {}px"></iframe>"""


def find_browser():
    """Return the path of Chromium; without it skip the test, or fail in CI."""
    for name in NAMES:
        path = shutil.which(name)
        if path:
            return path
    told = f'no browser: none of {", ".join(NAMES)} is in the PATH'
    if os.environ.get('CI') == 'true':
        pytest.fail(f'{told}; .ci/run installs chromium')
    pytest.skip(told)


def seen(page, width, height, folder, name):
    """
    Return as a dict what Chromium shows of a report in a window of a given width.

    page: path of the report; folder: where the opened copy is written; name: of the screenshot.
    """
    text = Path(page).read_text(encoding='utf-8')
    text = text.replace('<head>', f'<head>{LISTEN}', 1).replace('</body>', f'{LOOK}</body>')
    (folder / 'seen.html').write_text(text, encoding='utf-8')
    frame = folder / 'frame.html'
    frame.write_text(FRAME.format(width, height), encoding='utf-8')
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    picture = SCREENSHOTS / f'{name}-{width}.png'
    picture.unlink(missing_ok=True)
    ended = subprocess.run(
        [find_browser(), '--headless=new', '--no-sandbox', '--disable-gpu', '--hide-scrollbars',
         '--disable-dev-shm-usage', f'--user-data-dir={folder / "profile"}',
         f'--window-size={width},{height}', '--virtual-time-budget=15000', '--dump-dom',
         f'--screenshot={picture}', frame.as_uri()],
        capture_output=True, text=True, timeout=GUARD_S, check=False)
    found = re.search(r'<pre id="seen">(.*?)</pre>', ended.stdout, re.DOTALL)
    assert found, ended.stderr[-2000:]
    assert picture.stat().st_size > 0
    return json.loads(unescape(found[1]))
