// A file as the body of a POST, with progress (fetch cannot tell it).
import { t } from "../i18n";
import { problemOf } from "./api";
import { inPlace, places } from "./places";
import { unreachable } from "./problem";

/** However many files are chosen, there are places for what somebody waits for. */
const oneAtATime = places(1);

/** The answer's JSON. */
export function upload<Answer>(
  path: string,
  file: File,
  onProgress: (share: number) => void,
  contentType = "application/octet-stream",
): Promise<Answer> {
  const send = () =>
    new Promise<Answer>((resolve, reject) => {
      const request = new XMLHttpRequest();
      request.open("POST", `/api${path}`);
      request.setRequestHeader("content-type", contentType);
      request.upload.onprogress = (event) => {
        if (event.lengthComputable) onProgress(event.loaded / event.total);
      };
      const fail = () => reject(unreachable(t("problem.upload")));
      request.onerror = request.onabort = fail;
      request.onload = () => {
        const { status, responseText } = request;
        const answer = new Response(status === 205 ? null : responseText || null, {
          status: Math.min(status, 599), // a Response takes none beyond, and none of 205 has a body
          headers: { "content-type": request.getResponseHeader("content-type") ?? "" },
        });
        if (answer.ok)
          answer.json().then(resolve, fail); // some proxy's own page
        else void problemOf(answer).then(reject, reject);
      };
      request.send(file);
    });
  return oneAtATime(() => inPlace(send));
}
