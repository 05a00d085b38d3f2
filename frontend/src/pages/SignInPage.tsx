// Before anything of the server is shown: sign in, or make the first admin.
import { useState } from "preact/hooks";
import { t } from "../i18n";
import { makeFirstAdmin, signIn } from "../sources/accessApi";
import { session } from "../state/session";
import { EntryForm } from "./EntryForm";

function NotEncrypted() {
  return (
    <p class="refused" role="alert" data-testid="not-encrypted">
      {t("entry.notEncrypted")}
    </p>
  );
}

function FirstAdmin({ encrypted }: { encrypted: boolean }) {
  const [code, setCode] = useState("");
  return (
    <EntryForm
      title={t("entry.firstAdmin")}
      submit={t("entry.firstAdmin.submit")}
      fresh
      onSubmit={(name, password) => makeFirstAdmin(code, name, password).then((now) => (session.value = now))}
    >
      {!encrypted && <NotEncrypted />}
      <p>{t("entry.firstAdmin.explain")}</p>
      <label for="entry-code">{t("entry.code")}</label>
      <input
        id="entry-code"
        data-testid="entry-code"
        autocomplete="off"
        autocapitalize="characters"
        spellcheck={false}
        required
        maxLength={100}
        value={code}
        onInput={(e) => setCode(e.currentTarget.value)}
      />
    </EntryForm>
  );
}

export function SignInPage() {
  const now = session.value;
  if (now === null || now === "unreachable") return null;
  return (
    <div class="page entry-page" data-testid="sign-in-page">
      {now.mode === "waiting" ? (
        <FirstAdmin encrypted={now.encrypted} />
      ) : (
        <EntryForm
          title={t("entry.signIn")}
          submit={t("entry.signIn")}
          fresh={false}
          onSubmit={(name, password) => signIn(name, password).then((entered) => (session.value = entered))}
        >
          {!now.encrypted && <NotEncrypted />}
        </EntryForm>
      )}
    </div>
  );
}
