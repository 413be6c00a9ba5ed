// Builds the page as ONE file, dist/index.html, with script and style inline.
import { defineConfig, type Plugin } from 'vite';

const NONCE = 'nonce="KERF_NONCE"'; // replaced by the server and in exported files

/** Moves script and style into the page; fails if anything else would be loaded. */
function oneFile(): Plugin {
  return {
    name: 'one-file',
    enforce: 'post',
    generateBundle(_options, bundle) {
      const page = bundle['index.html'];
      if (page?.type !== 'asset') throw new Error('index.html is missing');
      let html = String(page.source);
      for (const [name, file] of Object.entries(bundle)) {
        if (file === page) continue;
        const escaped = name.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');
        if (file.type === 'chunk') {
          const code = file.code.replace(/<\/(script)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');
          const tag = new RegExp(`\\s*<script[^>]*src="[^"]*${escaped}"[^>]*></script>`);
          html = html.replace(tag, '');
          // At the end of the body: after the data of an exported file, and when all elements exist.
          html = html.replace('</body>', () => `<script type="module" ${NONCE}>${code}</script>\n</body>`);
        } else {
          const tag = new RegExp(`<link[^>]*href="[^"]*${escaped}"[^>]*>`);
          html = html.replace(tag, () => `<style ${NONCE}>${String(file.source)}</style>`);
        }
        delete bundle[name];
      }
      if (/<script[^>]*\ssrc=|<link[^>]*rel="stylesheet"/.test(html))
        throw new Error('the page would load further files');
      page.source = html;
    },
  };
}

export default defineConfig({
  base: './',
  build: {
    target: 'es2022',
    outDir: 'dist',
    assetsInlineLimit: 1 << 30,
    cssCodeSplit: false,
    modulePreload: false,
    chunkSizeWarningLimit: 2000,
    rollupOptions: { output: { inlineDynamicImports: true } },
  },
  plugins: [oneFile()],
});
