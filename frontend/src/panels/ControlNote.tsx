// Who steers the search: seen in the bar; asked for, given, kept, taken and given up below it.
import { report, send } from "../commands/send";
import { t } from "../i18n";
import { serverNowMs } from "../state/connection";
import { type ControlView, controlView, UNANSWERED_S } from "../state/control";
import { me } from "../state/session";
import type { Command } from "../wire";

type Kind = Extract<Command["kind"], `${string}_control`>;

const order = (missionId: string, kind: Kind) => () => {
  report("control", null);
  void send("control", missionId, { kind });
};

function Order({ missionId, kind, main = false }: { missionId: string; kind: Kind; main?: boolean }) {
  return (
    <button type="button" class={main ? "primary" : ""} data-testid={kind} onClick={order(missionId, kind)}>
      {t(`command.${kind}`)}
    </button>
  );
}

/** In the bar, among the words on the mission. */
export function WhoSteers() {
  const view = controlView.value;
  if (view === null) return null;
  const { holder } = view.control;
  const words = view.mine ? t("steer.you") : holder ? t("steer.other", { name: holder.name }) : t("steer.nobody");
  return (
    <span data-testid="who-steers" data-mine={view.mine}>
      {words}
    </span>
  );
}

function secondsToWait({ control }: ControlView): number {
  if (control.askedAt === null) return 0;
  return Math.max(0, Math.ceil(UNANSWERED_S - (serverNowMs.value - Date.parse(control.askedAt)) / 1000));
}

/** An operator who does not steer may ask, and take what nobody answers; a pilot takes at once. */
function Others({ view }: { view: ControlView }) {
  const { missionId, control } = view;
  const person = me.value;
  if (person === null || person.role === "viewer") return null;
  if (control.holder === null) return <Order missionId={missionId} kind="take_control" />;
  if (person.role === "pilot") return <Order missionId={missionId} kind="take_control" main />;
  if (!view.askedByMe) return <Order missionId={missionId} kind="ask_control" />;
  const seconds = secondsToWait(view);
  if (seconds === 0) return <Order missionId={missionId} kind="take_control" main />;
  return <span>{t("steer.waiting", { name: control.holder.name, seconds })}</span>;
}

export function ControlNote() {
  const view = controlView.value;
  if (view === null) return null;
  const { missionId, control } = view;
  if (view.asksMe && control.asked) {
    return (
      <div class="urgent-note control-note asked" role="alert" data-testid="control-note">
        <span>{t("steer.asksYou", { name: control.asked.name })}</span>
        <Order missionId={missionId} kind="give_control" main />
        <Order missionId={missionId} kind="keep_control" />
      </div>
    );
  }
  const parts = view.mine ? <Order missionId={missionId} kind="release_control" /> : <Others view={view} />;
  return (
    <div class="urgent-note control-note" data-testid="control-note">
      {parts}
    </div>
  );
}
