// Where a flight's own sweeps speak against the antenna that was measured, it is said once the flight is over.
import { useEffect, useState } from "preact/hooks";
import { reasonText, t } from "../i18n";
import * as api from "../sources/api";
import type { AntennaReview } from "../wire";

/** To be kept, and given to the server that flies next. */
export function SavePattern({ proposed: { filename, text } }: { proposed: NonNullable<AntennaReview["proposed"]> }) {
  return (
    <a class="button" data-testid="antenna-save" download={filename} href={`data:application/json,${encodeURIComponent(text)}`}>
      {t("whatIf.antenna.save")}
    </a>
  );
}

/** To be keyed by what it was asked of: it asks once. */
export function AntennaDoubt({ missionId, emitterId }: { missionId: string; emitterId: string }) {
  const [found, setFound] = useState<AntennaReview | null>(null);
  useEffect(() => {
    // where it cannot be told, the button of the what-if says why
    api.antennaReview(missionId, emitterId).then(setFound, () => {});
  }, []);
  if (!found?.doubt) return null;
  return (
    <div data-testid="antenna-doubt">
      <p class="refused">{reasonText(found.doubt)}</p>
      {found.proposed && <SavePattern proposed={found.proposed} />}
    </div>
  );
}
