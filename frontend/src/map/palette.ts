// Map colours of both themes. No red and no amber: they belong to alerts.

export interface Palette {
  ground: string;
  /** Of the basemap seen from afar. */
  land: string;
  water: string;
  river: string;
  town: string;
  grid: string;
  gridMajor: string;
  ink: string;
  halo: string;
  accent: string;
  area: string;
  fence: string;
  noFly: string;
  bearingLow: string;
  bearingHigh: string;
  rose: string;
  path: string;
  c95: string;
  /** Shades 0 (dropped first) .. 4 (survived), 5: chosen. */
  rounds: readonly [string, string, string, string, string, string];
}

export const palettes: Record<"outdoor" | "indoor", Palette> = {
  outdoor: {
    ground: "#fbfbf8",
    land: "#f4f3ec",
    water: "#cfdee6",
    river: "#b3cbd8",
    town: "#41484d",
    grid: "#e3e3dc",
    gridMajor: "#c9c9c0",
    ink: "#111111",
    halo: "#ffffff",
    accent: "#0047b3",
    area: "#111111",
    fence: "#3a5a40",
    noFly: "#5b4b8a",
    bearingLow: "#9a8fa8",
    bearingHigh: "#7a0f8a",
    rose: "#0b6e6e",
    path: "#0047b3",
    c95: "#000000",
    rounds: ["#d5dade", "#aeb8c0", "#808e99", "#54636f", "#1d2c38", "#0047b3"],
  },
  indoor: {
    ground: "#14181c",
    land: "#1d242a",
    water: "#0b1218",
    river: "#2d3f4d",
    town: "#b9c3ca",
    grid: "#22292f",
    gridMajor: "#333c44",
    ink: "#f2f5f7",
    halo: "#0c0f12",
    accent: "#7db7ff",
    area: "#f2f5f7",
    fence: "#9ccfa5",
    noFly: "#b9a8f0",
    bearingLow: "#6d6478",
    bearingHigh: "#f0a6ff",
    rose: "#5fd6d0",
    path: "#7db7ff",
    c95: "#ffffff",
    rounds: ["#39434b", "#55626c", "#7b8a95", "#a9b7c1", "#e2eaf0", "#7db7ff"],
  },
};
