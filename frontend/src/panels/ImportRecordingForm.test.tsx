// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import { t } from "../i18n";
import * as api from "../sources/api";
import { FakeSource } from "../sources/fakeSource";
import { live } from "../state/connection";
import { missionAt } from "../state/mission";
import { look } from "../state/moment";
import { open } from "../state/open";
import type { RecordingImport } from "../wire";
import { ended, phase, record, someSpec, started } from "../wire/examples";
import { ImportRecording, submit } from "./ImportRecording";

afterEach(() => act(() => render(null, document.body)));

it("keeps what was typed while its flight is looked back at", () => {
  const all = record({ kind: "mission_drafted", spec: someSpec() }, started(), phase("flying"), phase("ground"), ended("aborted"));
  open(new FakeSource());
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  act(() => render(<ImportRecording />, document.body));
  document.querySelector<HTMLInputElement>("[name=place]")!.value = "50.6, 7.2";
  for (const seq of [3, null]) act(() => look(seq));
  expect(document.querySelector<HTMLInputElement>("[name=place]")!.value).toBe("50.6, 7.2");
});

it("tells no quality of bearings that came without a sweep", async () => {
  const sweep = { sweep_id: "", place_number: 1, place: { lat: 50, lon: 7 }, bearing_deg: 90, sigma_deg: 7, quality: 1, reason: null };
  const found: RecordingImport = {
    ...{ recording_id: "r", filename: "f.csv", already: false, iq_kept: false, remarks: [], last_seq: 2 },
    sweeps: [{ ...sweep, accepted: true }],
  };
  vi.spyOn(api, "importRecording").mockResolvedValueOnce(found);
  open(new FakeSource());
  const all = record({ kind: "mission_drafted", spec: someSpec() });
  live.value = { ...live.value, mission: missionAt(all, Number.POSITIVE_INFINITY), events: all };
  const chosen = vi.spyOn(FormData.prototype, "getAll").mockReturnValueOnce([new File(["50,7,90"], "f.csv")]);
  await submit(all[0]!.mission_id, document.createElement("form"));
  chosen.mockRestore();
  act(() => render(<ImportRecording />, document.body));
  const line = document.querySelector("[data-testid=recording-found] li")!.textContent;
  expect(line).toBe(`${t("sweep.place", { number: 1 })} ${t("sweep.bearing", { bearing: "090°", sigma: "7.0" })}`);
});
