// Before the start: the checklist that refuses, with remedies, and the slide that starts.
import { signal } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";
import { SlideToConfirm } from "../commands/SlideToConfirm";
import { asProblem, report, send } from "../commands/send";
import { slideNext } from "../commands/suggested";
import { type MessageKey, reasonRemedy, reasonText, t } from "../i18n";
import { source } from "../state/connection";
import { mission } from "../state/shown";
import { unbroken } from "../units/unbroken";
import type { CheckFact } from "../wire";
import { ProblemNote } from "./ProblemNote";

const checking = signal(false);

export async function runPreflight(missionId: string): Promise<void> {
  const from = source.peek();
  if (!from || checking.peek()) return;
  checking.value = true;
  report("start", null);
  try {
    await from.preflight(missionId);
  } catch (error) {
    report("start", asProblem(error));
  } finally {
    checking.value = false;
  }
}

/** What refuses the start stands first, then what to take note of. */
const rank = (check: CheckFact): number => (check.ok ? 2 : check.blocking ? 0 : 1);

export function PreflightPanel({ missionId }: { missionId: string }) {
  const { checks, preflightPassed, spec } = mission.value;
  const [sliding, setSliding] = useState(slideNext.peek() === missionId);
  useEffect(() => {
    if (checks === null && spec) void runPreflight(missionId);
  }, [missionId, checks === null, spec === null]);
  useEffect(() => {
    slideNext.value = null;
  }, []);
  const refusing = checks?.filter((c) => !c.ok && c.blocking).length ?? 0;
  return (
    <section class="panel preflight" data-testid="preflight" data-passed={preflightPassed ?? ""} aria-label={t("preflight.title")}>
      <h2>
        {t("preflight.title")}
        <button type="button" data-testid="preflight-run" disabled={checking.value} onClick={() => void runPreflight(missionId)}>
          {t(checking.value ? "preflight.running" : checks ? "preflight.again" : "preflight.run")}
        </button>
      </h2>
      <ProblemNote desk="start" />
      {checks === null && !checking.value && <p class="muted">{t("preflight.none")}</p>}
      {checks && (
        <>
          <p class={preflightPassed ? "" : "refused"}>
            <strong>{preflightPassed ? t("preflight.passed") : t("preflight.failed", { count: refusing })}</strong>
          </p>
          <ul class="checks">
            {checks
              .toSorted((a, b) => rank(a) - rank(b))
              .map((check, i) => {
                const remedy = reasonRemedy(check.reason);
                const verdict = check.ok ? "ok" : check.blocking ? "notOk" : "warning";
                return (
                  <li class={`check-${verdict}`} key={i} data-testid="check" data-ok={check.ok}>
                    <span class="check-mark" role="img" aria-label={t(`preflight.${verdict}`)}>
                      {check.ok ? "✓" : check.blocking ? "✕" : "!"}
                    </span>
                    <span>
                      <strong>{t(`check.${check.name}` satisfies MessageKey)}</strong> {unbroken(reasonText(check.reason))}
                      {!check.ok && remedy && <em class="problem-remedy">{t("problem.remedy", { remedy: unbroken(remedy) })}</em>}
                    </span>
                  </li>
                );
              })}
          </ul>
        </>
      )}
      <div class="start-foot">
        {sliding && preflightPassed ? (
          <SlideToConfirm
            label={t("preflight.slide")}
            testId="start-slider"
            onConfirm={() => send("start", missionId, { kind: "start" }).then(() => setSliding(false))}
            onCancel={() => setSliding(false)}
          />
        ) : (
          <div class="start-row">
            <a class="button" href={`#/mission/${encodeURIComponent(missionId)}/edit`} data-testid="edit">
              {t("preflight.edit")}
            </a>
            <button type="button" class="primary" data-testid="start" disabled={!preflightPassed} onClick={() => setSliding(true)}>
              {t("preflight.start")}
            </button>
          </div>
        )}
      </div>
    </section>
  );
}
