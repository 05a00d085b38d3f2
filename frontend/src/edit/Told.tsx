import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";

/** What is said between the fields and the buttons. On a phone it scrolls with the fields: what is new comes into sight. */
export function Told({ news, children }: { news: unknown; children: ComponentChildren }) {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (news) box.current!.scrollIntoView({ block: "nearest" });
  }, [news]);
  return (
    <div class="edit-told" ref={box}>
      {children}
    </div>
  );
}
