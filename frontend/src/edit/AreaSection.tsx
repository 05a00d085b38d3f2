// Where it may be: drawn, imported or typed; fence and no-fly areas beside it.
import { useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { reasonText, t } from "../i18n";
import { problemWords } from "../panels/ProblemNote";
import * as api from "../sources/api";
import { localProblem, RequestFailed } from "../sources/problem";
import { areaM2, cornerCount, cornersFromText, polygonsOf, type Rings } from "../state/areas";
import { settings } from "../state/settings";
import { formatArea } from "../units/quantities";
import type { Area } from "../wire";
import { coverage } from "./coverage";
import { change, draft } from "./draft";
import { add, addRead, remove, replaces, tool, type What, what } from "./drawing";
import { firstEmitter, PRIOR } from "./emitter";
import { FormField, Message, PlaceField } from "./FormField";
import type { NumberField } from "./fields";
import { NotAPlan, readPlan } from "./qgcPlan";

const MARGIN: NumberField = { kind: "number", path: "flight.fence_margin_m", label: "edit.fence.marginValue", unit: "m", min: 0 };

interface ReadFile {
  parts: readonly [What, Rings[]][];
  told: string[];
}

/** Throws when it cannot be read. */
async function readFile(file: File, kind: What): Promise<ReadFile> {
  const text = await file.text();
  if (!/\.plan$/i.test(file.name)) return readArea(text, file.name, kind);
  const { inclusions, exclusions } = readPlan(text);
  return {
    parts: [
      [kind === "area" && !draft.peek()?.hasArea ? "area" : "fence", inclusions],
      ["noFly", exclusions],
    ],
    told: [],
  };
}

async function readArea(text: string, name: string, kind: What): Promise<ReadFile> {
  const { area, notes } = await api.importArea(text, name);
  return { parts: [[kind, polygonsOf(area as Area)]], told: notes.map(reasonText) };
}

/** Puts what is read into the draft; returns what to tell. */
const taken = (reading: Promise<ReadFile>, name: string): Promise<{ isRead: boolean; told: string[] }> =>
  addRead(
    reading.catch((error: unknown) => {
      throw unread(name, error);
    }),
    ({ parts }) => {
      for (const [kind, polygons] of parts) add(kind, polygons);
    },
  ).then(
    ({ told }) => ({ isRead: true, told }),
    (error: unknown) => ({ isRead: false, told: [asProblem(error).detail] }),
  );

const unread = (name: string, error: unknown): RequestFailed => {
  const reason = error instanceof NotAPlan ? t(error.flaw) : problemWords(asProblem(error));
  return new RequestFailed(localProblem(t("edit.area"), t("edit.importFailed", { name, reason })));
};

/** A dropped or chosen file goes into what is being drawn; a note says what was left out or wrong. */
export async function takeFile(file: File, onTold: (lines: string[]) => void): Promise<void> {
  onTold((await taken(readFile(file, what.peek()), file.name)).told);
}

function Paste({ onTold }: { onTold: (lines: string[]) => void }) {
  const [text, setText] = useState("");
  const use = () => {
    if (/^\s*[{[]/.test(text)) {
      void taken(readArea(text, "pasted.geojson", what.peek()), "GeoJSON").then(({ isRead, told }) => {
        if (isRead) setText("");
        onTold(told);
      });
      return;
    }
    const found = cornersFromText(text);
    if ("ring" in found) {
      add(what.peek(), [[found.ring]]);
      setText("");
      onTold([]);
    } else if ("unreadable" in found) onTold([`${found.unreadable.line}: ${found.unreadable.text}. ${t("edit.notPlace")}`]);
    else onTold([t("edit.tooFew")]);
  };
  return (
    <details class="more">
      <summary>{t("edit.area.paste")}</summary>
      <label class="visually-hidden" for="paste-area">
        {t("edit.area.typed")}
      </label>
      <textarea
        id="paste-area"
        data-testid="paste-area"
        rows={5}
        value={text}
        placeholder={"50.73400 N 7.09800 E\n50.73400 N 7.10200 E\n50.73550 N 7.10200 E"}
        onInput={(e) => setText(e.currentTarget.value)}
      />
      <button type="button" data-testid="paste-apply" disabled={text.trim() === ""} onClick={use}>
        {t("edit.area.pasteApply")}
      </button>
    </details>
  );
}

function Prior({ failed }: { failed: RequestFailed | null }) {
  const { prior } = firstEmitter(draft.value!.spec);
  const centre = () => {
    const corners = polygonsOf(draft.peek()!.spec.area as Area).flat(2);
    const mean = (i: 0 | 1) => corners.reduce((sum, p) => sum + p[i], 0) / corners.length;
    return { lat: mean(1), lon: mean(0) };
  };
  const choose = (kind: string) => {
    if (kind === "gaussian") change(PRIOR, { kind, centre: centre(), sigma_major_m: 50, sigma_minor_m: 50, major_axis_deg: 0 });
    else if (kind === "ring") change(PRIOR, { kind, centre: centre(), inner_m: 30, outer_m: 300 });
    else change(PRIOR, { kind: "uniform" });
  };
  const metres = (name: string, label: NumberField["label"]): NumberField => ({
    kind: "number",
    path: `${PRIOR}.${name}`,
    label,
    unit: "m",
  });
  return (
    <>
      <div class="field">
        <label for="prior-kind">{t("edit.prior")}</label>
        <select id="prior-kind" value={prior.kind} onChange={(e) => choose(e.currentTarget.value)}>
          <option value="uniform">{t("edit.prior.uniform")}</option>
          <option value="gaussian">{t("edit.prior.gaussian")}</option>
          <option value="ring">{t("edit.prior.ring")}</option>
        </select>
        <Message id="prior-kind" text={failed?.fieldMessage(PRIOR) ?? null} />
      </div>
      {prior.kind !== "uniform" && <PlaceField path={`${PRIOR}.centre`} label={t("edit.prior.centre")} failed={failed} />}
      {prior.kind === "gaussian" && (
        <>
          <FormField field={metres("sigma_major_m", "edit.prior.sigmaMajor")} failed={failed} />
          <FormField field={metres("sigma_minor_m", "edit.prior.sigmaMinor")} failed={failed} />
          <FormField field={{ kind: "number", path: `${PRIOR}.major_axis_deg`, label: "edit.prior.axis", unit: "°" }} failed={failed} />
        </>
      )}
      {prior.kind === "ring" && (
        <>
          <FormField field={metres("inner_m", "edit.prior.inner")} failed={failed} />
          <FormField field={metres("outer_m", "edit.prior.outer")} failed={failed} />
        </>
      )}
    </>
  );
}

const KINDS: readonly { what: What; label: "edit.draw.area" | "edit.draw.fence" | "edit.draw.noFly" }[] = [
  { what: "area", label: "edit.draw.area" },
  { what: "fence", label: "edit.draw.fence" },
  { what: "noFly", label: "edit.draw.noFly" },
];

function DrawTools({ onTold }: { onTold: (lines: string[]) => void }) {
  const flip = (chosen: typeof tool.value) => (tool.value = tool.value === chosen ? "none" : chosen);
  return (
    <div class="draw-tools">
      <label class="field-inline">
        {t("edit.draw.what")}
        <select
          data-testid="draw-what"
          value={what.value}
          onChange={(e) => {
            tool.value = "none";
            what.value = e.currentTarget.value as What;
          }}
        >
          {KINDS.map((k) => (
            <option value={k.what} key={k.what}>
              {t(k.label)}
            </option>
          ))}
        </select>
      </label>
      {what.value === "area" && draft.value?.hasArea && !draft.value.suggested && (
        <label class="check">
          <input
            type="checkbox"
            data-testid="draw-replaces"
            checked={replaces.value}
            onChange={(e) => (replaces.value = e.currentTarget.checked)}
          />
          {t("edit.area.replaces")}
        </label>
      )}
      <button type="button" data-testid="draw-polygon" aria-pressed={tool.value === "polygon"} onClick={() => flip("polygon")}>
        {t("edit.area.draw")}
      </button>
      <button type="button" data-testid="draw-rectangle" aria-pressed={tool.value === "rectangle"} onClick={() => flip("rectangle")}>
        {t("edit.area.rectangle")}
      </button>
      <button type="button" data-testid="draw-corners" aria-pressed={tool.value === "corners"} onClick={() => flip("corners")}>
        {t("edit.area.edit")}
      </button>
      <label class="button">
        {t("edit.area.import")}
        <input
          class="visually-hidden"
          type="file"
          data-testid="import-file"
          accept=".geojson,.json,.kml,.plan"
          onChange={(e) => {
            const file = e.currentTarget.files?.[0];
            e.currentTarget.value = "";
            if (file) void takeFile(file, onTold);
          }}
        />
      </label>
    </div>
  );
}

interface Properties {
  failed: RequestFailed | null;
  told: readonly string[];
  onTold: (lines: string[]) => void;
}

export function AreaSection({ failed, told, onTold }: Properties) {
  const now = draft.value!;
  const units = settings.value.units;
  const fence = now.spec.flight.fence as Area | null;
  return (
    <fieldset class="panel" data-testid="area-section">
      <legend>{t("edit.section.area")}</legend>
      <DrawTools onTold={onTold} />
      <p class="muted">{tool.value === "none" ? t("edit.area.importHint") : t("edit.area.drawing")}</p>
      {told.map((line) => (
        <p class="field-message" role="alert" data-testid="area-message" key={line}>
          {line}
        </p>
      ))}
      <div class="area-row">
        <span data-testid="area-size" data-has={now.hasArea} data-suggested={now.suggested}>
          <strong>{t("edit.area")}:</strong>{" "}
          {now.hasArea
            ? t("edit.area.have", { area: formatArea(areaM2(now.spec.area as Area), units), corners: cornerCount(now.spec.area as Area) })
            : t("edit.area.none")}
          {now.suggested && <span class="muted"> {t("edit.area.suggested")}</span>}
        </span>
        {now.hasArea && (
          <button type="button" data-testid="area-clear" onClick={() => remove("area")}>
            {t("edit.area.clear")}
          </button>
        )}
      </div>
      {coverage.value && (
        <p class={coverage.value.covered ? "muted" : ""} data-testid="coverage" data-covered={coverage.value.covered}>
          {reasonText(coverage.value.summary)}
        </p>
      )}
      {(failed?.fieldMessage("area") || failed?.fieldMessage("area.coordinates")) && (
        <p class="field-message" role="alert">
          {failed.fieldMessage("area") ?? failed.fieldMessage("area.coordinates")}
        </p>
      )}
      <div class="area-row">
        <span>
          <strong>{t("edit.fence")}:</strong>{" "}
          {fence ? t("edit.fence.own", { area: formatArea(areaM2(fence), units) }) : t("edit.fence.margin")}
        </span>
        {fence && (
          <button type="button" onClick={() => remove("fence")}>
            {t("edit.fence.remove")}
          </button>
        )}
      </div>
      {!fence && <FormField field={MARGIN} failed={failed} />}
      {(now.spec.flight.no_fly as Area[]).map((area, i) => (
        <div class="area-row" key={i}>
          <span>
            <strong>
              {t("edit.noFly")} {i + 1}:
            </strong>{" "}
            {formatArea(areaM2(area), units)}
          </span>
          <button type="button" aria-label={t("edit.noFly.remove", { number: i + 1 })} onClick={() => remove("noFly", i)}>
            {t("edit.area.clear")}
          </button>
        </div>
      ))}
      <Paste onTold={onTold} />
      <Prior failed={failed} />
    </fieldset>
  );
}
