// Reading and replacing a value deep inside plain objects and lists, by "a.0.c". Nothing is changed in place.
// "a.all.c" is the first one's c, and setting it sets the c of all alike.

type Plain = Record<string, unknown>;

export function get(object: unknown, path: string): unknown {
  return path.split(".").reduce<unknown>((at, key) => (at as Plain | undefined)?.[key === "all" ? 0 : key], object);
}

export function set<T>(object: T, path: string, value: unknown): T {
  const [key, ...rest] = path.split(".");
  const plain = object as unknown as Plain;
  if (key === "all") {
    const name = rest[0]!;
    const first = set((object as Plain[])[0]!, rest.join("."), value);
    return (object as Plain[]).map((one) => ({ ...one, [name]: first[name] })) as T;
  }
  const next = rest.length === 0 ? value : set(plain[key!] ?? {}, rest.join("."), value);
  if (Array.isArray(object)) return object.with(Number(key), next) as T;
  return { ...plain, [key!]: next } as T;
}
