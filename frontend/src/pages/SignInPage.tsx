// Before anything of the server is shown: sign in, make the first admin, or choose a new password after one was lost.
import { useState } from "preact/hooks";
import { t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import { makeFirstAdmin, providerAddress, recover, type SessionState, signIn } from "../sources/accessApi";
import { type Fault, faultOf, providerProblem } from "../sources/providerProblem";
import { COUNTS, phonesNext } from "../state/invite";
import { go, type Route } from "../state/route";
import { session } from "../state/session";
import { EntryForm } from "./EntryForm";

function NotEncrypted() {
  return (
    <p class="refused" role="alert" data-testid="not-encrypted">
      {t("entry.notEncrypted")}
    </p>
  );
}

function Code({ value, onInput }: { value: string; onInput: (value: string) => void }) {
  return (
    <>
      <label for="entry-code">{t("entry.code")}</label>
      <input
        id="entry-code"
        data-testid="entry-code"
        autocomplete="off"
        autocapitalize="characters"
        spellcheck={false}
        required
        maxLength={100}
        value={value}
        onInput={(e) => onInput(e.currentTarget.value)}
      />
    </>
  );
}

/** given: by the link that the server prints. Whoever made the account lets the others in next. */
function FirstAdmin({ encrypted, given }: { encrypted: boolean; given: string }) {
  const [code, setCode] = useState(given);
  const [phones, setPhones] = useState(1);
  return (
    <EntryForm
      title={t("entry.firstAdmin")}
      submit={t("entry.firstAdmin.submit")}
      fresh
      onSubmit={async (name, password) => {
        const entered = await makeFirstAdmin(code, name, password);
        phonesNext.value = phones;
        go("#/people");
        session.value = entered;
      }}
    >
      {!encrypted && <NotEncrypted />}
      <p>{t("entry.firstAdmin.explain")}</p>
      <Code value={code} onInput={setCode} />
      <label for="entry-phones">{t("entry.firstAdmin.invite")}</label>
      <select
        id="entry-phones"
        data-testid="entry-phones"
        value={String(phones)}
        onChange={(e) => setPhones(Number(e.currentTarget.value))}
      >
        {[0, ...COUNTS].map((each) => (
          <option value={String(each)} key={each}>
            {t("people.forPhones", { count: each })}
          </option>
        ))}
      </select>
    </EntryForm>
  );
}

function LostPassword({ encrypted, onBack }: { encrypted: boolean; onBack: () => void }) {
  const [code, setCode] = useState("");
  return (
    <>
      <EntryForm
        title={t("entry.lost.title")}
        submit={t("entry.lost.submit")}
        fresh
        nameless
        onSubmit={(_, password) => recover(code, password).then((now) => (session.value = now))}
      >
        {!encrypted && <NotEncrypted />}
        <p>{t("entry.lost.explain")}</p>
        <Code value={code} onInput={setCode} />
      </EntryForm>
      <button type="button" class="entry-other" onClick={onBack}>
        {t("entry.back")}
      </button>
    </>
  );
}

function SignIn({ now, fault }: { now: SessionState; fault: Fault | null }) {
  const [lost, setLost] = useState(false);
  if (lost) return <LostPassword encrypted={now.encrypted} onBack={() => setLost(false)} />;
  return (
    <>
      <EntryForm
        title={t("entry.signIn")}
        submit={t("entry.signIn")}
        fresh={false}
        onSubmit={async (name, password) => {
          const entered = await signIn(name, password);
          if (fault !== null) go("#/");
          session.value = entered;
        }}
      >
        {!now.encrypted && <NotEncrypted />}
        {fault !== null && <ProblemBox problem={providerProblem(fault)} testId="provider-problem" />}
        {now.provider !== null && (
          <a class="button" href={providerAddress} data-testid="entry-provider">
            {t("entry.provider", { name: now.provider })}
          </a>
        )}
      </EntryForm>
      <button type="button" class="entry-other" data-testid="entry-lost" onClick={() => setLost(true)}>
        {t("entry.lost")}
      </button>
    </>
  );
}

export function SignInPage({ route }: { route: Route }) {
  const now = session.value;
  const fault = route.page === "signIn" ? faultOf(route.fault) : null;
  if (now === null || now === "unreachable") return null;
  return (
    <div class="page entry-page" data-testid="sign-in-page">
      {now.mode === "waiting" ? (
        <FirstAdmin encrypted={now.encrypted} given={route.page === "firstAdmin" ? route.code : ""} />
      ) : (
        <SignIn now={now} fault={fault} />
      )}
    </div>
  );
}
