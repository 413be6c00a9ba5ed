// Makes the folder of the page without a server, for any server of static files:
//     node static.mjs DIST ENGINE FOLDER PROGRAM...
// DIST has the page and its worker (build.sh), ENGINE has kerf.js and kerf.wasm (./dev wasm); the programs can be
// opened from the page.
import { createHash } from 'node:crypto';
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';

const [dist, engine, folder, ...programs] = process.argv.slice(2);
if (!folder) throw new Error('usage: node static.mjs DIST ENGINE FOLDER PROGRAM...');

/** Fails if the page has changed, so that nothing is served half. */
function replaced(text, mark, by) {
  if (!text.includes(mark)) throw new Error(`the page has no ${mark}`);
  return text.replaceAll(mark, by);
}

let page = readFileSync(join(dist, 'index.html'), 'utf8');
page = replaced(page, '<!--KERF_DATA-->', '<script type="text/plain" id="kerf-engine" nonce="KERF_NONCE">worker.js</script>');
page = replaced(page, 'worker-src blob:', "worker-src 'self'");
// The page is a file that never changes, so a random nonce would protect nothing; this one keeps its bytes the same.
page = replaced(page, 'KERF_NONCE', createHash('sha256').update(page).digest('base64url').slice(0, 24));

// Origins whose pages may steer this one in a frame, besides its own.
page = replaced(page, 'KERF_FRAMES', '');

rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, 'programs'), { recursive: true });
writeFileSync(join(folder, 'index.html'), page);
copyFileSync(join(dist, 'worker.js'), join(folder, 'worker.js'));
for (const name of ['kerf.js', 'kerf.wasm']) copyFileSync(join(engine, name), join(folder, name));
for (const program of programs) copyFileSync(program, join(folder, 'programs', basename(program)));
const files = programs.map((program) => basename(program)).sort();
writeFileSync(join(folder, 'programs', 'index.json'), JSON.stringify({ files }));
