import { minify } from "terser";
import type { Plugin } from "vite";

/** terser over what oxc has minified: 4 kB of the page after gzip (ADR 16). */
export function minifyAgain(): Plugin {
  return {
    name: "minify-again",
    apply: "build",
    enforce: "post",
    async generateBundle(_, bundle) {
      for (const file of Object.values(bundle)) {
        if (file.type !== "chunk") continue;
        const { code } = await minify(file.code, { module: true, compress: { passes: 2 } });
        if (code) file.code = code;
      }
    },
  };
}
