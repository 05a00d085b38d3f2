// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { expect, it, vi } from "vitest";
import { localProblem, RequestFailed } from "../sources/problem";
import { upload } from "../sources/upload";
import { ways } from "../state/ways";
import { WaysCard } from "./WaysCard";

vi.mock("../sources/upload", () => ({ upload: vi.fn() }));

it("says beside what is folded, which it is when its page is opened again, that a file was refused", async () => {
  ways.value = { features: [], notes: [] } as unknown as typeof ways.value;
  vi.mocked(upload).mockRejectedValue(new RequestFailed(localProblem("Upload", "it is empty")));
  act(() => render(<WaysCard missionId="m" />, document.body));
  const input = document.querySelector<HTMLInputElement>("[data-testid=ways-upload]")!;
  Object.defineProperty(input, "files", { value: [new File(["x"], "a.kml")] });
  await act(async () => void input.dispatchEvent(new Event("change")));
  expect(document.querySelector("[data-testid=ways-problem]")?.textContent).toContain("it is empty");
  expect(document.querySelector("[data-testid=ways-problem]")?.closest("details")).toBeNull();
  act(() => render(null, document.body));
});
