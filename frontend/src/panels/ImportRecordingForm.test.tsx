// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { live } from "../state/connection";
import { missionAt } from "../state/mission";
import { look } from "../state/moment";
import { open } from "../state/open";
import { ended, phase, record, someSpec, started } from "../wire/examples";
import { ImportRecording } from "./ImportRecording";

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
