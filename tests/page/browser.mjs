// One browser for all tests of a process; each page has a context of its own.
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { chromium } from 'playwright-core';

const ARGUMENTS = ['--headless', '--no-sandbox', '--use-gl=angle', '--use-angle=gl-egl',
  '--ignore-gpu-blocklist', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--force-color-profile=srgb'];

export const DEADLINE_MS = 30_000;

export async function openBrowser() {
  const folder = await mkdtemp(path.join(tmpdir(), 'earthwork-page-'));
  const browser = await chromium.launch({
    executablePath: process.env.EARTHWORK_CHROMIUM ?? '/usr/bin/chromium',
    args: [...ARGUMENTS, `--disk-cache-dir=${folder}`],
    env: { ...process.env, FONTCONFIG_FILE: path.join(import.meta.dirname, 'fonts.conf') },
  });
  return {
    // A page in a context of its own, which remembers nothing of others. `options` are those of
    // playwright's newContext. What the page complains about is in page.complaints.
    async page(options = {}) {
      const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
      return openTab(context);
    },
    async close() {
      await browser.close();
      await rm(folder, { recursive: true, force: true });
    },
  };
}

// Another page of the same context: another tab.
export async function openTab(context) {
  const page = await context.newPage();
  page.setDefaultTimeout(DEADLINE_MS);
  page.complaints = [];
  page.on('pageerror', (error) => page.complaints.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') page.complaints.push(message.text());
  });
  return page;
}

export const NARROW = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true,
  deviceScaleFactor: 2 };
