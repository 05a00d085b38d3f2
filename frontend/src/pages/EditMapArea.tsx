// The editor's map, loaded when it is needed; a file dropped on it is read into the draft.
import type { ComponentType } from "preact";
import { useEffect, useState } from "preact/hooks";
import { takeFile } from "../edit/AreaSection";
import { t } from "../i18n";

export function EditMapArea({ onTold }: { onTold: (lines: string[]) => void }) {
  const [state, setState] = useState<"loading" | "none" | { Map: ComponentType<{ onFile: (file: File) => void }> }>("loading");
  useEffect(() => {
    void import("../map/createMap").then(
      async ({ hasWebgl }) => {
        if (!hasWebgl()) setState("none");
        else {
          const { EditMap } = await import("../map/EditMap");
          setState({ Map: EditMap });
        }
      },
      () => setState("none"),
    );
  }, []);
  return (
    <div class="map-area">
      {state === "loading" && <p class="center muted">{t("map.loading")}</p>}
      {state === "none" && <p class="center">{t("map.noWebgl")}</p>}
      {typeof state === "object" && <state.Map onFile={(file) => void takeFile(file, onTold)} />}
    </div>
  );
}
