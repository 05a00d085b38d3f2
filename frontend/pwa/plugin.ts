// Writes the service worker of a build: which files the page has, and a version that changes with any of them.
import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import type { Plugin } from "vite";

const template = fileURLToPath(new URL("worker.js", import.meta.url));

/** publicDir: its files are copied beside the built ones. */
export function serviceWorker(publicDir: string): Plugin {
  return {
    name: "service-worker",
    apply: "build",
    enforce: "post",
    generateBundle(_, bundle) {
      const digest = createHash("sha256");
      const plain = readdirSync(publicDir).sort();
      for (const name of plain) digest.update(name).update(readFileSync(`${publicDir}/${name}`));
      const built = Object.values(bundle).sort((a, b) => a.fileName.localeCompare(b.fileName));
      for (const file of built) digest.update(file.fileName).update(file.type === "chunk" ? file.code : file.source);
      const files = [...new Set(["index.html", ...plain, ...built.map((file) => file.fileName)])];
      const source = readFileSync(template, "utf8")
        .replace("__FILES__", JSON.stringify(files.map((file) => `./${file}`)))
        .replace("__VERSION__", digest.digest("hex").slice(0, 12));
      this.emitFile({ type: "asset", fileName: "sw.js", source });
    },
  };
}
