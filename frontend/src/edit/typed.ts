// Words typed into a field. What can be read is taken with each letter; what cannot is kept, and said when one has left it.
import { useEffect, useState } from "preact/hooks";
import { draft, shownFields, type } from "./draft";

/** parse: null where the words cannot be read. */
export function useTyped<T>(path: string, shown: string, parse: (words: string) => T | null, take: (value: T) => void) {
  const [typed, setWords] = useState<string | null>(null);
  const kept = draft.value!.text[path];
  const isReplaced = typed !== null && kept === undefined && parse(typed) === null; // by a preset, say
  const words = isReplaced ? null : typed;
  useEffect(() => {
    shownFields.add(path);
    return () => {
      shownFields.delete(path);
    };
  }, [path]);
  return {
    isWrong: words === null && kept !== undefined,
    input: {
      value: words ?? kept ?? shown,
      onInput: (e: { currentTarget: { value: string } }) => {
        const typed = e.currentTarget.value;
        const value = parse(typed);
        setWords(typed);
        if (value !== null) take(value);
        type(path, value === null ? typed : null);
      },
      onBlur: () => setWords(null),
      onKeyDown: ({ key }: { key: string }) => key === "Enter" && setWords(null),
    },
  };
}
