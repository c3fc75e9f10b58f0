// Pictures of the page as people see it, for README and for whoever changed how it looks.
//
//   node tests/page/screenshot.mjs URL OUT.png [WIDTHxHEIGHT] [light|dark]
//
// Waits for the first picture that has all that is in view. `tests/npm_ci.sh` fetches what it needs.
import { DEADLINE_MS, openBrowser } from './browser.mjs';

const SIZE = /^(\d{2,4})x(\d{2,4})$/;

const [url, out, size = '1280x800', colorScheme = 'light'] = process.argv.slice(2);
const [, width, height] = (size.match(SIZE) ?? []).map(Number);
if (!out || !width || !['light', 'dark'].includes(colorScheme)) {
  console.error('usage: screenshot.mjs URL OUT.png [WIDTHxHEIGHT] [light|dark]');
  process.exit(2);
}

const browser = await openBrowser();
try {
  const page = await browser.page({ viewport: { width, height }, colorScheme });
  await page.goto(url);
  await page.waitForFunction(() => window.earthwork?.figures?.().whole_picture_ms,
    null, { timeout: DEADLINE_MS });
  await page.screenshot({ path: out });
  for (const complaint of page.complaints) console.error(complaint);
  if (page.complaints.length > 0) process.exitCode = 1;
} finally {
  await browser.close();
}
