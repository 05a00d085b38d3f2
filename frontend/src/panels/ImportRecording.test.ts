import { describe, expect, it } from "vitest";
import { recordingForm } from "./ImportRecording";

const file = new File(["heading_deg,power_db"], "turn.csv");

describe("recordingForm", () => {
  it("carries files, place and time", () => {
    const form = recordingForm([file], "50.6 7.2", "2026-05-01T10:00:30");
    expect(form).toBeInstanceOf(FormData);
    const entries = Object.fromEntries((form as FormData).entries());
    expect(entries).toMatchObject({ lat: "50.6", lon: "7.2", at_utc: "2026-05-01T10:00:30Z" });
  });

  it("leaves out what the file tells itself", () => {
    expect([...(recordingForm([file], " ", "") as FormData).keys()]).toEqual(["files"]);
  });

  it("says what is missing or cannot be read", () => {
    expect(recordingForm([], "", "")).toMatch(/file/i);
    expect(recordingForm([file], "behind the barn", "")).toMatch(/place/i);
  });
});
