// The page's typeface, asked for once the first page has arrived: on a thin link the safety bar never waits for it.

let asked = false;

export function wearTypeface(): void {
  if (asked) return;
  asked = true;
  const file = new URL("../style/inter.woff2", import.meta.url).href;
  const face = new FontFace("Inter", `url("${file}")`, { weight: "400 700" });
  document.fonts.add(face);
  face.load().catch(() => undefined); // the system's own stays
}
