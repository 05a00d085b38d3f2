// What this browser keeps.

/** False: a full storage or a private window's, which keeps nothing. */
export function keep(key: string, value: unknown): boolean {
  try {
    localStorage.setItem(key, JSON.stringify(value));
    return true;
  } catch {
    return false;
  }
}

type Where = "localStorage" | "sessionStorage";

/** null: nothing, or a browser that keeps nothing at all. */
export function kept(key: string, where: Where = "localStorage"): string | null {
  try {
    return globalThis[where].getItem(key);
  } catch {
    return null;
  }
}

export function drop(key: string, where: Where = "localStorage"): void {
  try {
    globalThis[where].removeItem(key);
  } catch {
    // it keeps nothing
  }
}
