// What sign-in, first admin and invitation have in common: a narrow card, a name, a password, one button.
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import type { Problem } from "../wire";
import "../style/people.css";

interface Properties {
  title: string;
  submit: string;
  /** The password is new, and managers of passwords shall offer one. */
  fresh: boolean;
  /** The code says who it is. */
  nameless?: boolean;
  children?: ComponentChildren;
  onSubmit: (name: string, password: string) => Promise<unknown>;
}

export function EntryForm({ title, submit, fresh, nameless = false, children, onSubmit }: Properties) {
  const [problem, setProblem] = useState<Problem | null>(null);
  const [sending, setSending] = useState(false);
  const [name, setName] = useState("");
  const [password, setPassword] = useState("");
  return (
    <form
      class="card entry"
      data-testid="entry"
      onSubmit={(e) => {
        e.preventDefault();
        setProblem(null);
        setSending(true);
        onSubmit(name, password)
          .catch((error: unknown) => setProblem(asProblem(error)))
          .finally(() => setSending(false));
      }}
    >
      <p class="muted entry-product">Crossfix</p>
      <h1>{title}</h1>
      {children}
      {!nameless && (
        <>
          <label for="entry-name">{t("entry.name")}</label>
          <input
            id="entry-name"
            data-testid="entry-name"
            autocomplete="username"
            required
            maxLength={40}
            value={name}
            onInput={(e) => setName(e.currentTarget.value)}
          />
        </>
      )}
      <label for="entry-password">{t(nameless ? "password.new" : "entry.password")}</label>
      <input
        id="entry-password"
        data-testid="entry-password"
        type="password"
        autocomplete={fresh ? "new-password" : "current-password"}
        required
        maxLength={200}
        value={password}
        onInput={(e) => setPassword(e.currentTarget.value)}
      />
      {fresh && <p class="muted">{t("entry.passwordHint")}</p>}
      {problem && <ProblemBox problem={problem} />}
      <button type="submit" class="primary" data-testid="entry-submit" disabled={sending}>
        {submit}
      </button>
    </form>
  );
}
