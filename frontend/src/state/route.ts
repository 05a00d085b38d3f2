// Which page is shown: the part of the address after '#'.
import { signal } from "@preact/signals";

export type Route =
  | { page: "missions" }
  | { page: "new"; from: string | null }
  | { page: "edit"; missionId: string }
  | { page: "mission"; missionId: string }
  | { page: "area"; missionId: string }
  | { page: "bearings"; missionId: string }
  | { page: "maps" }
  | { page: "health" }
  | { page: "calibration" }
  | { page: "report"; missionIds: string[] }
  | { page: "compare"; missionIds: string[] }
  | { page: "people" }
  | { page: "join"; code: string }
  | { page: "signIn"; fault: string }
  | { page: "firstAdmin"; code: string };

/** A link that was mangled on its way is read as it came. */
function decoded(part: string): string {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}

export function parseRoute(hash: string): Route {
  const parts = hash.replace(/^#\/?/, "").split("/").map(decoded);
  const id = parts[1];
  if (parts[0] === "new") return { page: "new", from: id ?? null };
  if (parts[0] === "maps" || parts[0] === "health" || parts[0] === "people" || parts[0] === "calibration") return { page: parts[0] };
  if ((parts[0] === "report" || parts[0] === "compare") && id) return { page: parts[0], missionIds: parts.slice(1) };
  if (parts[0] === "sign-in" && id) return { page: "signIn", fault: id };
  if (parts[0] === "first-admin" && id) return { page: "firstAdmin", code: id };
  if (parts[0] === "join" && id) return { page: "join", code: id };
  if (parts[0] === "mission" && id) {
    const below = parts[2];
    return { page: below === "edit" || below === "area" || below === "bearings" ? below : "mission", missionId: id };
  }
  return { page: "missions" };
}

export const route = signal<Route>(parseRoute(location.hash));
addEventListener("hashchange", () => {
  route.value = parseRoute(location.hash);
});

export const areaAddress = (id: string) => `${missionAddress(id)}/area`;
/** Where somebody with an antenna in their hand reports what they hear. */
export const bearingsAddress = (id: string) => `${missionAddress(id)}/bearings`;
export const missionAddress = (id: string) => `#/mission/${encodeURIComponent(id)}`;

export function go(hash: string): void {
  location.hash = hash;
}
