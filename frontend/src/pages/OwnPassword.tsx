// One's own password: the old one is asked for, and all other devices are signed out.
import { useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import { changePassword } from "../sources/accessApi";
import { me } from "../state/session";
import type { Problem } from "../wire";

interface FieldProperties {
  id: string;
  label: string;
  autocomplete: "current-password" | "new-password";
  value: string;
  onInput: (value: string) => void;
}

function PasswordField({ id, label, autocomplete, value, onInput }: FieldProperties) {
  return (
    <>
      <label for={id}>{label}</label>
      <input
        id={id}
        data-testid={id}
        type="password"
        autocomplete={autocomplete}
        required
        maxLength={200}
        value={value}
        onInput={(e) => onInput(e.currentTarget.value)}
      />
    </>
  );
}

function Form({ name, onChanged }: { name: string; onChanged: () => void }) {
  const [old, setOld] = useState("");
  const [fresh, setFresh] = useState("");
  const [state, setState] = useState<"asking" | "sending" | "done">("asking");
  const [problem, setProblem] = useState<Problem | null>(null);
  const done = () => {
    setOld("");
    setFresh("");
    setState("done");
    onChanged();
  };
  const fail = (error: unknown) => {
    setProblem(asProblem(error));
    setState("asking");
  };
  return (
    <form
      class="card entry"
      data-testid="own-password"
      onSubmit={(e) => {
        e.preventDefault();
        setProblem(null);
        setState("sending");
        changePassword(old, fresh).then(done, fail);
      }}
    >
      {/* managers of passwords keep it under this name */}
      <input type="text" autocomplete="username" value={name} hidden readOnly />
      <PasswordField id="password-old" label={t("password.old")} autocomplete="current-password" value={old} onInput={setOld} />
      <PasswordField id="password-new" label={t("password.new")} autocomplete="new-password" value={fresh} onInput={setFresh} />
      <p class="muted">{t("entry.passwordHint")}</p>
      {problem && <ProblemBox problem={problem} />}
      {state === "done" && (
        <p role="status" data-testid="password-done">
          {t("password.done")}
        </p>
      )}
      <button type="submit" data-testid="password-submit" disabled={state === "sending"}>
        {t("password.submit")}
      </button>
    </form>
  );
}

export function OwnPassword({ onChanged }: { onChanged: () => void }) {
  const person = me.value;
  if (person === null) return null;
  return (
    <section>
      <div class="page-head">
        <h1>{t("password.title")}</h1>
      </div>
      {person.has_password ? <Form name={person.name} onChanged={onChanged} /> : <p class="muted">{t("password.none")}</p>}
    </section>
  );
}
