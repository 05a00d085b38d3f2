// A file as the body of a POST, with progress (fetch cannot tell it).
import { t } from "../i18n";
import { problemOf } from "./api";
import { unreachable } from "./problem";

export function upload(path: string, file: File, onProgress: (share: number) => void): Promise<void> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("POST", `/api${path}`);
    request.setRequestHeader("content-type", "application/octet-stream");
    request.upload.onprogress = (event) => {
      if (event.lengthComputable) onProgress(event.loaded / event.total);
    };
    request.onerror = () => reject(unreachable(t("problem.upload")));
    request.onload = () => {
      if (request.status < 300) resolve();
      else {
        const answer = new Response(request.responseText, {
          status: request.status,
          headers: { "content-type": request.getResponseHeader("content-type") ?? "" },
        });
        void problemOf(answer).then(reject, reject);
      }
    };
    request.send(file);
  });
}
