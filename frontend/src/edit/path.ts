// Reading and replacing a value deep inside plain objects and lists, by "a.0.c". Nothing is changed in place.

type Plain = Record<string, unknown>;

export function get(object: unknown, path: string): unknown {
  return path.split(".").reduce<unknown>((at, key) => (at as Plain | undefined)?.[key], object);
}

export function set<T>(object: T, path: string, value: unknown): T {
  const [key, ...rest] = path.split(".");
  const plain = object as unknown as Plain;
  const next = rest.length === 0 ? value : set(plain[key!] ?? {}, rest.join("."), value);
  if (Array.isArray(object)) return object.with(Number(key), next) as T;
  return { ...plain, [key!]: next } as T;
}
