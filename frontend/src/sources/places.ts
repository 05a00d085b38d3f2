// Over HTTP/1.1 a browser opens six connections to a server. Whatever is no order shares four of them: an order finds one free.

/** Runs so much work at a time; the rest waits its turn, or until it is no longer wanted. */
export function places(free: number) {
  const waiting = new Set<() => void>();
  return async <T>(work: () => Promise<T>, wanted?: AbortSignal): Promise<T> => {
    wanted?.throwIfAborted();
    if (free > 0) free--;
    else
      await new Promise<void>((begin, leave) => {
        waiting.add(begin);
        wanted?.addEventListener("abort", () => {
          waiting.delete(begin);
          leave(wanted.reason);
        });
      });
    try {
      return await work();
    } finally {
      const [next] = waiting;
      if (next) {
        waiting.delete(next);
        next();
      } else free++;
    }
  };
}

export const inPlace = places(4);
