// What axe-core finds wrong with a page, as lines to be read in a test's report.
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';

const source = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

export async function violations(page) {
  // Evaluated by the debugger, for the page's policy lets in no script of others.
  if (!await page.evaluate(() => 'axe' in window)) await page.evaluate(source);
  const { violations: found } = await page.evaluate(() => window.axe.run());
  return found.flatMap(({ id, impact, nodes }) =>
    nodes.map((node) => `${impact} ${id}: ${node.html} ${node.any.map((check) => check.message)}`));
}
