// Tokens of machines: a payload's agent, a program that fetches exports. The secret is shown once.
import { useState } from "preact/hooks";
import { t } from "../i18n";
import * as access from "../sources/accessApi";
import type { Try } from "./PeoplePage";

const SCOPES: readonly access.Scope[] = ["payload", "exports", "metrics", "bearings"];

export function Machines({ list, attempt }: { list: access.Token[]; attempt: Try }) {
  const [name, setName] = useState("");
  const [scope, setScope] = useState<access.Scope>("payload");
  const [made, setMade] = useState<access.MadeToken | null>(null);
  return (
    <section>
      <div class="page-head">
        <h1>{t("people.machines")}</h1>
      </div>
      <form
        class="card person"
        onSubmit={(e) => {
          e.preventDefault();
          attempt(access.makeToken(name, scope).then(setMade));
          setName("");
        }}
      >
        <div class="person-acts">
          <input
            required
            maxLength={40}
            placeholder={t("people.machineName")}
            aria-label={t("people.machineName")}
            value={name}
            onInput={(e) => setName(e.currentTarget.value)}
          />
          <select aria-label={t("people.scope")} value={scope} onChange={(e) => setScope(e.currentTarget.value as access.Scope)}>
            {SCOPES.map((each) => (
              <option value={each} key={each}>
                {t(`people.scope.${each}`)}
              </option>
            ))}
          </select>
          <button type="submit" data-testid="make-token">
            {t("people.makeToken")}
          </button>
        </div>
      </form>
      {made && (
        <div class="card" data-testid="made-token">
          <p>{t("people.token.explain", { name: made.token.name })}</p>
          <input readOnly value={made.secret} aria-label={t("people.token")} onFocus={(e) => e.currentTarget.select()} />
        </div>
      )}
      <ul class="cards">
        {list.map((one) => (
          <li class="card person" key={one.token_id} data-testid="token">
            <span>
              <strong>{one.name}</strong> <span class="muted">{t(`people.scope.${one.scope}`)}</span>
            </span>
            <button type="button" onClick={() => attempt(access.revokeToken(one.token_id).then(() => setMade(null)))}>
              {t("people.revoke")}
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
