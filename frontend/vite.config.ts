import { fileURLToPath } from "node:url";
import { defineConfig } from "vitest/config";
import { serviceWorker } from "./pwa/plugin";
import { minifyAgain } from "./scripts/minifyAgain";

const server = process.env.CROSSFIX_SERVER ?? "http://127.0.0.1:8600";

/** What the safety bar needs comes in one file instead of fifteen. */
const bar = { name: "bar", tags: ["$initial" as const] };

/** MapLibre and all that it imports, in one file: the page and MapLibre's worker both run it. */
const map = { name: "maplibre", test: /maplibre-gl\/src|maplibreWorker/ };

const here = (path: string) => fileURLToPath(new URL(path, import.meta.url));

/** ADR 16. The development server uses the package's finished files. */
const builtFromSources = [
  { find: /^maplibre-gl$/, replacement: here("node_modules/maplibre-gl/src/index.ts") },
  { find: "maplibre-gl/dist/maplibre-gl-worker.mjs?worker&url", replacement: here("src/map/maplibreWorker.ts") },
  { find: "maplibre-gl/worker", replacement: here("node_modules/maplibre-gl/src/source/worker.ts") },
  { find: /^\.\/(globe|vertical_perspective)_(projection|transform|camera_helper)\.ts$/, replacement: here("src/map/maplibreGlobe.ts") },
  { find: "@maplibre/mlt", replacement: here("src/map/maplibreTiles.ts") },
];

/** What is loaded together, and pages that are seldom opened: files of a few kilobytes pack worse each by itself. */
const together = [
  { name: "edit", test: /src\/(edit\/(?!pro|path)|pages\/(Area|Edit))/, includeDependenciesRecursively: false },
  { name: "reasons.de", test: /src\/i18n\/(de\.ts|german|reasons\.de)/, includeDependenciesRecursively: false },
  { name: "reasons.en", test: /src\/i18n\/(pages|reasons)\.en/, includeDependenciesRecursively: false },
  { name: "seldom", test: /src\/pages\/(Calibration|Compare|Health|Join|Maps)Page/, includeDependenciesRecursively: false },
];

export default defineConfig(({ command }) => ({
  base: "./",
  plugins: [minifyAgain(), serviceWorker(here("public"))],
  worker: { format: "es" },
  resolve: { alias: command === "build" ? builtFromSources : [] },
  // MapLibre declares fields that its base classes fill
  oxc: { assumptions: { setPublicClassFields: true }, typescript: { removeClassFieldsWithoutInitializer: true } },
  build: {
    target: "es2022",
    sourcemap: false,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1200,
    rolldownOptions: { checks: { pluginTimings: false }, output: { codeSplitting: { groups: [map, bar, ...together] } } },
  },
  server: { host: "127.0.0.1", proxy: { "/api": { target: server, ws: true } } },
  test: {
    isolate: false,
    setupFiles: ["src/freshForTests.ts", "src/i18n/forTests.ts"],
    include: ["src/**/*.test.ts", "src/**/*.test.tsx"],
  },
}));
