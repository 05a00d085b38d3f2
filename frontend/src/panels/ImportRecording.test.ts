import { describe, expect, it } from "vitest";
import { recordingForm } from "./ImportRecording";

function typed(fields: Record<string, string>, names = ["turn.csv"]): FormData {
  const given = new FormData();
  for (const name of names) given.append("files", new File(["heading_deg,power_db"], name));
  for (const [name, value] of Object.entries(fields)) given.append(name, value);
  return given;
}

describe("recordingForm", () => {
  it("carries files, and what they do not tell in the server's units", () => {
    const all = {
      place: "50.6 7.2",
      at: "2026-05-01T10:00:30",
      emitter_id: "emitter-2",
      tag: " lynx 4 ",
      offset_deg: "-3,5",
      frequency_hz: "148.5",
      pulse_width_s: "20",
      pulse_period_s: "1.3",
    };
    const form = recordingForm(typed(all));
    expect(form).toBeInstanceOf(FormData);
    expect(Object.fromEntries((form as FormData).entries())).toMatchObject({
      lat: "50.6",
      lon: "7.2",
      at_utc: "2026-05-01T10:00:30Z",
      emitter_id: "emitter-2",
      tag: "lynx 4",
      offset_deg: "-3.5",
      frequency_hz: "148500000",
      pulse_width_s: "0.02",
      pulse_period_s: "1.3",
    });
  });

  it("carries the pattern of the antenna where one was chosen", () => {
    const given = typed({});
    given.append("antenna", new File([], ""));
    expect([...(recordingForm(given) as FormData).keys()]).toEqual(["files"]);
    given.set("antenna", new File(["{}"], "loop.json"));
    expect(((recordingForm(given) as FormData).get("antenna") as File).name).toBe("loop.json");
  });

  it("leaves out what the file tells itself", () => {
    expect([...(recordingForm(typed({ place: " ", at: "", tag: " " })) as FormData).keys()]).toEqual(["files"]);
  });

  it("says what is missing or cannot be read", () => {
    expect(recordingForm(typed({}, []))).toMatch(/file/i);
    expect(recordingForm(typed({ place: "behind the barn" }))).toMatch(/place/i);
    expect(recordingForm(typed({ pulse_width_s: "short" }))).toMatch(/pulse width/i);
  });
});
