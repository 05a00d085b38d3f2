import { defineConfig } from "vitest/config";

const server = process.env.CROSSFIX_SERVER ?? "http://127.0.0.1:8000";

export default defineConfig({
  base: "./",
  worker: { format: "es" },
  build: { target: "es2022", sourcemap: false, chunkSizeWarningLimit: 1200 },
  server: { host: "127.0.0.1", proxy: { "/api": { target: server, ws: true } } },
  test: { include: ["src/**/*.test.ts", "src/**/*.test.tsx"] },
});
