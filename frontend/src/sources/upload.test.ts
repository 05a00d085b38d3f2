// @vitest-environment happy-dom
import { beforeEach, expect, it, vi } from "vitest";
import { t } from "../i18n";
import { health } from "./api";
import { RequestFailed } from "./problem";
import { upload } from "./upload";

/** Uploads that were sent, and whose answers come when the test says so. */
class Sent {
  static all: Sent[] = [];
  readonly upload: Partial<XMLHttpRequestUpload> = {};
  path = "";
  status = 0;
  responseText = "";
  onload = () => {};
  onerror = () => {};
  open(_method: string, path: string) {
    this.path = path;
  }
  setRequestHeader() {}
  getResponseHeader = () => "application/json";
  send() {
    Sent.all.push(this);
  }
  answer(status: number, text: string) {
    Object.assign(this, { status, responseText: text });
    this.onload();
  }
}

const turn = () => new Promise((resolve) => setTimeout(resolve));
const begun = async () => {
  await turn();
  return Sent.all.map(({ path }) => path);
};
const send = (path: string) =>
  upload(path, new File(["x"], "x"), () => undefined).catch((error: unknown) => (error instanceof RequestFailed ? error.problem : error));

beforeEach(() => {
  Sent.all = [];
  vi.stubGlobal("XMLHttpRequest", Sent);
});

it("goes out one at a time, whatever becomes of the one before, and leaves places for what somebody waits for", async () => {
  const asked = vi.fn(() => Promise.resolve(new Response("{}")));
  vi.stubGlobal("fetch", asked);
  const answers = ["/1", "/2", "/3", "/4", "/5", "/6", "/7"].map(send);
  expect(await begun()).toEqual(["/api/1"]);
  await health();
  expect(asked).toHaveBeenCalledOnce();
  Sent.all[0]!.answer(201, '{"id":"one"}');
  expect(await begun()).toEqual(["/api/1", "/api/2"]);
  Sent.all[1]!.onerror();
  expect(await begun()).toHaveLength(3);
  Sent.all[2]!.answer(409, '{"detail":"no room"}');
  expect(await begun()).toHaveLength(4);
  Sent.all[3]!.answer(200, "<title>Sign in to this network</title>"); // some proxy's own page
  expect(await begun()).toHaveLength(5);
  Sent.all[4]!.answer(999, "denied"); // some proxy's own number
  expect(await begun()).toHaveLength(6);
  Sent.all[5]!.answer(205, "{}"); // it has no body by its standard, and browsers read one all the same
  expect(await begun()).toHaveLength(7);
  Sent.all[6]!.answer(201, "{}");
  expect(await Promise.all(answers)).toMatchObject([
    { id: "one" },
    { detail: t("problem.upload") },
    { status: 409, detail: "no room" },
    { detail: t("problem.upload") },
    { status: 599 },
    { detail: t("problem.upload") },
    {},
  ]);
});
