// Khronos' validator over GLB files: node validate.mjs FILE.glb... Exits 1, naming each message,
// if it has anything at all to say: an error, a warning, an information or a hint.
import { readFile } from 'node:fs/promises';
import { basename } from 'node:path';
import validator from 'gltf-validator';

const severities = ['error', 'warning', 'information', 'hint'];

async function validate(path) {
  const bytes = new Uint8Array(await readFile(path));
  const report = await validator.validateBytes(bytes, { uri: basename(path), maxIssues: 20 });
  for (const issue of report.issues.messages) {
    const severity = severities[issue.severity];
    console.error(`${path}: ${severity}: ${issue.code} at ${issue.pointer}: ${issue.message}`);
  }
  if (report.issues.messages.length === 0) {
    const { totalVertexCount, totalTriangleCount } = report.info;
    console.log(`${path}: nothing to say (${totalVertexCount} vertices, ` +
                `${totalTriangleCount} triangles)`);
  }
  return report.issues.messages.length === 0 && !report.issues.truncated;
}

const paths = process.argv.slice(2);
if (paths.length === 0) {
  console.error('usage: node validate.mjs FILE.glb...');
  process.exit(2);
}
let good = true;
for (const path of paths) good = (await validate(path)) && good;
process.exit(good ? 0 : 1);
