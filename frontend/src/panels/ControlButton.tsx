// Who steers the search: seen in the bar, taken, asked for and given up behind it. Whoever is asked answers below the bar.
import { report, send } from "../commands/send";
import { t } from "../i18n";
import { serverNowMs } from "../state/connection";
import { type ControlView, controlView, UNANSWERED_S } from "../state/control";
import { overlay, toggle } from "../state/overlay";
import { me } from "../state/session";
import type { Command } from "../wire";
import { ProblemNote } from "./ProblemNote";

type Kind = Extract<Command["kind"], `${string}_control`>;

function Order({ missionId, kind, main = false }: { missionId: string; kind: Kind; main?: boolean }) {
  const order = async () => {
    report("control", null);
    if ((await send("control", missionId, { kind })) && overlay.peek() === "control") overlay.value = null;
  };
  return (
    <button type="button" class={main ? "primary" : ""} data-testid={kind} onClick={() => void order()}>
      {t(`command.${kind}`)}
    </button>
  );
}

function secondsToWait({ control }: ControlView): number {
  if (control.askedAt === null) return 0;
  return Math.max(0, Math.ceil(UNANSWERED_S - (serverNowMs.value - Date.parse(control.askedAt)) / 1000));
}

/** An operator who does not steer may ask, and take what nobody answers; a pilot takes at once. */
function Acts({ view }: { view: ControlView }) {
  const { missionId, control, mine } = view;
  if (mine) return <Order missionId={missionId} kind="release_control" />;
  if (me.value?.role === "viewer") return <p class="muted">{t("steer.viewer")}</p>;
  if (control.holder === null || me.value?.role === "pilot") return <Order missionId={missionId} kind="take_control" main />;
  if (!view.askedByMe) return <Order missionId={missionId} kind="ask_control" main />;
  const seconds = secondsToWait(view);
  if (seconds === 0) return <Order missionId={missionId} kind="take_control" main />;
  return <p>{t("steer.waiting", { name: control.holder.name, seconds })}</p>;
}

function words({ mine, control: { holder } }: ControlView): string {
  if (mine) return t("steer.you");
  return holder ? t("steer.other", { name: holder.name }) : t("steer.nobody");
}

export function ControlButton() {
  const view = controlView.value;
  if (view === null) return null;
  const { mine, control } = view;
  const isOpen = overlay.value === "control";
  return (
    <div class="anchor">
      <button
        type="button"
        class={`steer ${mine ? "mine" : ""}`}
        data-testid="who-steers"
        data-mine={mine}
        aria-expanded={isOpen}
        title={words(view)}
        onClick={() => toggle("control")}
      >
        <span class="steer-label">{t("steer.label")}</span>
        <strong>{mine ? t("steer.short.you") : (control.holder?.name ?? t("steer.short.nobody"))}</strong>
      </button>
      {isOpen && (
        <div class="popover" role="dialog" aria-label={words(view)} data-testid="control-panel">
          <p>
            <strong>{words(view)}</strong>
          </p>
          <p class="muted">{t("steer.explain")}</p>
          <Acts view={view} />
          <ProblemNote desk="control" />
        </div>
      )}
    </div>
  );
}

/** Whoever steers is asked: it stays until they answer, or somebody takes control. */
export function ControlAsked() {
  const view = controlView.value;
  if (!view?.asksMe || !view.control.asked) return null;
  return (
    <div class="urgent-note control-asked" role="alert" data-testid="control-asked">
      <span>{t("steer.asksYou", { name: view.control.asked.name, seconds: secondsToWait(view) })}</span>
      <Order missionId={view.missionId} kind="give_control" main />
      <Order missionId={view.missionId} kind="keep_control" />
      <ProblemNote desk="control" />
    </div>
  );
}
