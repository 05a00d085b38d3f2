import { defineConfig } from "vitest/config";

const server = process.env.CROSSFIX_SERVER ?? "http://127.0.0.1:8600";

/** What the safety bar needs comes in one file instead of fifteen. */
const bar = { name: "bar", tags: ["$initial" as const] };

export default defineConfig({
  base: "./",
  worker: { format: "es" },
  build: {
    target: "es2022",
    sourcemap: false,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1200,
    rolldownOptions: { output: { codeSplitting: { groups: [bar] } } },
  },
  server: { host: "127.0.0.1", proxy: { "/api": { target: server, ws: true } } },
  test: { setupFiles: ["src/i18n/forTests.ts"], include: ["src/**/*.test.ts", "src/**/*.test.tsx"] },
});
