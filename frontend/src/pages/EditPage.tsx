// A new mission, or a draft edited: map on the left, the specification as a form on the right.
import { useEffect, useRef, useState } from "preact/hooks";
import { asFailure } from "../commands/send";
import { suggestedSpec } from "../commands/suggested";
import { AreaSection } from "../edit/AreaSection";
import { CompassCard } from "../edit/CompassCard";
import { watchCoverage } from "../edit/coverage";
import { begin, change, type Draft, draft, forgetSent, isStored, isUnread, storedDraft, textBeside, update } from "../edit/draft";
import { discard, settledDraft, tool } from "../edit/drawing";
import { EmitterListField } from "../edit/EmitterListField";
import { EMITTER, firstEmitter } from "../edit/emitter";
import { FormField, TextField } from "../edit/FormField";
import { type NumberField, sections } from "../edit/fields";
import { KindField } from "../edit/KindField";
import { MovementField } from "../edit/MovementField";
import { NotStored } from "../edit/NotStored";
import { PreviewCard } from "../edit/PreviewCard";
import { ProfileRow } from "../edit/ProfileRow";
import { isOfPreset, type PresetName, presetNames, presetOf, withPreset } from "../edit/presets";
import { clearPreview, forgetPreviewOfOthers } from "../edit/preview";
import { ReceiverBandField } from "../edit/ReceiverBandField";
import { RhythmFields } from "../edit/RhythmFields";
import { draftOnce, forgetSaving, savedMeanwhile } from "../edit/saving";
import { Told } from "../edit/Told";
import { t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import * as api from "../sources/api";
import { localProblem, RequestFailed } from "../sources/problem";
import { go, missionAddress, type Route } from "../state/route";
import type { MissionSpec } from "../wire";
import { EditMapArea } from "./EditMapArea";

type EditRoute = Extract<Route, { page: "new" | "edit" }>;

const keyOf = (route: EditRoute) => (route.page === "edit" ? route.missionId : route.from ? `new:${route.from}` : "new");

async function specFor(route: EditRoute): Promise<Pick<Draft, "spec" | "suggested" | "fromSeq">> {
  if (route.page === "edit") {
    const { spec, spec_seq: fromSeq } = await api.mission(route.missionId);
    return { spec: spec as MissionSpec, suggested: false, fromSeq };
  }
  if (route.from !== null) return { spec: (await api.mission(route.from)).spec as MissionSpec, suggested: false };
  return { spec: await suggestedSpec(), suggested: true };
}

const FREQUENCY: NumberField = { kind: "number", path: `${EMITTER}.frequency_hz`, label: "edit.frequency", unit: "MHz", scale: 1e6 };

function NameSection({ failed }: { failed: RequestFailed | null }) {
  const { spec } = draft.value!;
  const asList = spec.emitters.length > 1 || firstEmitter(spec).kind === "pulsed"; // who looks for tags looks for several
  return (
    <fieldset class="panel">
      <legend>{t("edit.section.name")}</legend>
      <TextField path="name" label={t("edit.name")} failed={failed} />
      <div class="field">
        <label for="preset">{t("edit.preset")}</label>
        <select
          id="preset"
          data-testid="preset"
          value={(draft.value && presetOf(draft.value.spec)) ?? ""}
          onChange={(e) => {
            const now = draft.peek();
            const name = e.currentTarget.value as PresetName | "";
            if (now && name) update({ ...now, spec: withPreset(now.spec, name), text: textBeside(now.text, isOfPreset) });
          }}
        >
          <option value="">–</option>
          {presetNames.map((name) => (
            <option value={name} key={name}>
              {t(`edit.preset.${name}`)}
            </option>
          ))}
        </select>
      </div>
      {asList ? (
        <EmitterListField />
      ) : (
        <>
          <TextField path={`${EMITTER}.label`} label={t("edit.label")} failed={failed} />
          <FormField field={FREQUENCY} failed={failed} />
        </>
      )}
      <KindField />
      <RhythmFields failed={failed} />
      <ReceiverBandField />
      <MovementField failed={failed} />
    </fieldset>
  );
}

function EquipmentSection() {
  const { sensor } = draft.value!.spec;
  return (
    <fieldset class="panel">
      <legend>{t("edit.profile")}</legend>
      <ProfileRow />
      {sensor.bearing_errors === "joint" && <CompassCard offsetDeg={sensor.bearing_offset_deg ?? 0} />}
    </fieldset>
  );
}

function Motion({ failed }: { failed: RequestFailed | null }) {
  const { motion } = draft.value!.spec.planner;
  const choose = (kind: string) => {
    const speed = draft.peek()!.spec.flight.speed_m_s;
    const fresh =
      kind === "linear"
        ? { kind, speed_m_s: speed }
        : kind === "full"
          ? { kind, turn_rate_deg_s: 30, acceleration_m_s2: 1, speed_m_s: 8, constant_s: 3 }
          : { kind: "linear_constant", speed_m_s: speed, constant_s: 11.2 };
    change("planner.motion", fresh);
  };
  return (
    <>
      <div class="field">
        <label for="motion-kind">{t("edit.motion")}</label>
        <select id="motion-kind" value={motion.kind} onChange={(e) => choose(e.currentTarget.value)}>
          <option value="linear">{t("edit.motion.linear")}</option>
          <option value="linear_constant">{t("edit.motion.linear_constant")}</option>
          <option value="full">{t("edit.motion.full")}</option>
        </select>
      </div>
      <FormField field={{ kind: "number", path: "planner.motion.speed_m_s", label: "edit.speed", unit: "m/s" }} failed={failed} />
      {motion.kind !== "linear" && (
        <FormField
          field={{ kind: "number", path: "planner.motion.constant_s", label: "edit.motion.constant", unit: "s" }}
          failed={failed}
        />
      )}
      {motion.kind === "full" && (
        <>
          <FormField
            field={{ kind: "number", path: "planner.motion.acceleration_m_s2", label: "edit.motion.acceleration", unit: "m/s²" }}
            failed={failed}
          />
          <FormField
            field={{ kind: "number", path: "planner.motion.turn_rate_deg_s", label: "edit.turnRate", unit: "°/s" }}
            failed={failed}
          />
        </>
      )}
    </>
  );
}

/** What hides a field that is marked is opened; it stays open when that has been mended. */
function openMarked(): void {
  for (const mark of document.querySelectorAll("details .field-message")) mark.closest("details")!.open = true;
}

function Sections({ failed }: { failed: RequestFailed | null }) {
  return (
    <>
      {sections.map((section) => {
        const asked = section.fields.filter(({ when }) => when?.(draft.value!.spec) ?? true);
        const more = asked.filter((f) => f.more);
        return (
          <fieldset class="panel" key={section.title}>
            <legend>{t(section.title)}</legend>
            {asked
              .filter((f) => !f.more)
              .map((field) => (
                <FormField field={field} failed={failed} key={field.path} />
              ))}
            {more.length > 0 && (
              <details class="more">
                <summary>{t("edit.more")}</summary>
                {more.map((field) => (
                  <FormField field={field} failed={failed} key={field.path} />
                ))}
                {section.title === "edit.section.planner" && <Motion failed={failed} />}
              </details>
            )}
          </fieldset>
        );
      })}
    </>
  );
}

/** Another draft is another form: what was wrong with one says nothing of the next. */
export function EditPage({ route }: { route: EditRoute }) {
  const [times, setTimes] = useState(0);
  const key = keyOf(route);
  const onAgain = () => setTimes(times + 1);
  const onDiscard = () => {
    discard(key);
    onAgain();
  };
  return <Editor route={route} draftKey={key} onAgain={onAgain} onDiscard={onDiscard} key={`${key} ${times}`} />;
}

interface Edited {
  route: EditRoute;
  draftKey: string;
  /** Reads it once more. */
  onAgain: () => void;
  onDiscard: () => void;
}

function Editor({ route, draftKey: key, onAgain, onDiscard }: Edited) {
  const [failed, setFailed] = useState<RequestFailed | null>(null);
  const [told, setTold] = useState<readonly string[]>([]);
  const [saving, setSaving] = useState(false);
  const [restored, setRestored] = useState(false);
  const isLeft = useRef(false);
  const typedIn = useRef<HTMLElement | null>(null);

  useEffect(() => {
    clearPreview();
    const kept = storedDraft(key);
    setRestored(kept !== null);
    if (kept) update(kept);
    else {
      draft.value = null; // what is typed until it has come would be lost
      specFor(route).then(
        (begun) => {
          if (!isLeft.current) begin({ key, ...begun, hasArea: true, text: {} });
        },
        (error: unknown) => setFailed(asFailure(error)),
      );
    }
    const stops = [watchCoverage(), forgetPreviewOfOthers()];
    return () => {
      isLeft.current = true;
      tool.value = "none"; // corners that were moved are kept
      draft.value = null; // the next page would show it until its own has come
      clearPreview();
      for (const stop of stops) stop();
    };
  }, []);

  const save = async (over?: number) => {
    const focused = document.activeElement as HTMLElement | null;
    typedIn.current = focused?.matches("input, textarea, select") ? focused : null;
    focused?.blur(); // what is typed there is taken, or marked
    setFailed(null);
    setSaving(true);
    try {
      const now = await settledDraft();
      if (!now || isLeft.current) return;
      const local = !now.hasArea ? t("edit.noArea") : isUnread(now) ? t("edit.invalid") : null;
      if (local) throw new RequestFailed(localProblem(t("menu.new"), local));
      const saved =
        route.page === "edit" ? await api.editMission(route.missionId, now.spec, over ?? now.fromSeq) : await draftOnce(key, now.spec);
      forgetSent(key, now.spec);
      forgetSaving(key);
      if (!isLeft.current) go(missionAddress(saved.mission_id));
    } catch (error) {
      setFailed(asFailure(error));
    } finally {
      setSaving(false);
    }
  };

  const now = draft.value?.key === key ? draft.value : null;
  const theirs = failed && savedMeanwhile(failed);
  useEffect(openMarked, [failed, !now]);
  useEffect(() => {
    if (!saving && document.activeElement === document.body) typedIn.current?.focus({ preventScroll: true }); // what is said is in sight
  }, [saving]);
  return (
    <div class="edit" data-testid="edit-page" inert={saving}>
      <EditMapArea onTold={setTold} />
      <form
        class="side"
        onSubmit={(e) => {
          e.preventDefault();
          void save();
        }}
      >
        <div class="panel edit-head">
          <h1>{t(route.page === "edit" ? "edit.title" : "menu.new")}</h1>
          {restored && (
            <span class="muted">
              {t("edit.restored")}{" "}
              <button type="button" data-testid="discard" onClick={onDiscard}>
                {t("edit.discard")}
              </button>
            </span>
          )}
        </div>
        <div class="edit-scroll">
          {now && (
            <>
              <NameSection failed={failed} />
              <AreaSection failed={failed} told={told} onTold={setTold} />
              <PreviewCard />
              <EquipmentSection />
              <Sections failed={failed} />
            </>
          )}
        </div>
        <Told news={failed}>
          {now && !isStored.value && <NotStored />}
          {failed && <ProblemBox problem={failed.problem} testId="edit-problem" />}
        </Told>
        <div class="panel edit-foot">
          {theirs !== null && (
            <div class="start-row">
              <button type="button" data-testid="save-over" onClick={() => save(theirs)}>
                {t("edit.saveOver")}
              </button>
              <button type="button" data-testid="take-theirs" onClick={onDiscard}>
                {t("edit.takeTheirs")}
              </button>
            </div>
          )}
          <div class="start-row">
            <a class="button" href={route.page === "edit" ? missionAddress(route.missionId) : "#/"}>
              {t("edit.cancel")}
            </a>
            {failed && !now ? (
              <button type="button" class="primary" data-testid="read-again" onClick={onAgain}>
                {t("app.reload")}
              </button>
            ) : (
              <button type="submit" class="primary" data-testid="save" disabled={saving || !now}>
                {t(saving ? "edit.saving" : "edit.save")}
              </button>
            )}
          </div>
        </div>
      </form>
    </div>
  );
}
