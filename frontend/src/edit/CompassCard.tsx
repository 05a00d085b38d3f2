// What the flights of the craft taught of its compass, beside the equipment; forgotten after a calibration.
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import * as api from "../sources/api";
import { formatNumber, signedDegrees } from "../units/quantities";
import type { CompassKnown, Problem } from "../wire";

/** Of the craft that a draft is planned for: the server's first. */
async function firstCompass(offsetDeg: number): Promise<CompassKnown | null> {
  const [first] = (await api.health()).vehicles;
  return first ? api.compass(first.craft_id, offsetDeg) : null;
}

function Known({ known, forget }: { known: CompassKnown; forget: () => void }) {
  const [asked, setAsked] = useState(false);
  const { antenna, flights, bearings, bias_deg, bias_spread_deg } = known;
  if (bias_deg === null || bias_spread_deg === null) return <p class="muted">{t("compass.unknown")}</p>;
  return (
    <>
      <p data-testid="compass-bias" data-flights={flights}>
        {t("compass.bias", { bias: signedDegrees(bias_deg), spread: Math.max(1, Math.round(bias_spread_deg)), flights, bearings, antenna })}
      </p>
      {known.places_known > 0 && (
        <p class="muted" data-testid="compass-places">
          {t("compass.places", { places: known.places_known })}
        </p>
      )}
      <p class="muted">
        {t("compass.expects", {
          bias: Math.max(1, Math.round(2 * known.expected_bias_deg)),
          scale: formatNumber(known.sigma_scale, 1),
          outliers: Math.max(1, Math.round(100 * known.outlier_rate)),
        })}
      </p>
      {asked ? (
        <div class="area-row">
          <span>{t("compass.forget.really", { flights })}</span>
          <button
            type="button"
            data-testid="compass-forget-yes"
            onClick={() => {
              setAsked(false);
              forget();
            }}
          >
            {t("compass.forget")}
          </button>
          <button type="button" onClick={() => setAsked(false)}>
            {t("compass.forget.keep")}
          </button>
        </div>
      ) : (
        <button type="button" data-testid="compass-forget" title={t("compass.forget.why")} onClick={() => setAsked(true)}>
          {t("compass.forget")}
        </button>
      )}
    </>
  );
}

/** offsetDeg: what the draft takes off its bearings. */
export function CompassCard({ offsetDeg }: { offsetDeg: number }) {
  const [known, setKnown] = useState<CompassKnown | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const ask = (answer: Promise<CompassKnown | null>) => {
    setProblem(null);
    answer.then(setKnown, (error: unknown) => setProblem(asProblem(error)));
  };
  useEffect(() => ask(firstCompass(offsetDeg)), [offsetDeg]);
  return (
    <details class="more" data-testid="compass">
      <summary>{t("compass.title")}</summary>
      {known && <Known known={known} forget={() => ask(api.forgetCompass(known.craft_id, offsetDeg))} />}
      {problem && <ProblemBox problem={problem} testId="compass-problem" />}
    </details>
  );
}
