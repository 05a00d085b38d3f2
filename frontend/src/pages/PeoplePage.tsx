// Where one is signed in; and for admins the people, their invitations and the machines.
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import * as access from "../sources/accessApi";
import { me, refreshSession, session } from "../state/session";
import { formatAge } from "../units/quantities";
import type { Problem } from "../wire";
import { Invitations } from "./Invitations";
import { Machines } from "./Machines";
import { OwnPassword } from "./OwnPassword";
import "../style/people.css";
import { RolePick } from "./RolePick";

const named = (words: string, names: readonly [RegExp, string][]) => names.find(([pattern]) => pattern.test(words))?.[1];

/** Browser and system as they name themselves, as far as it is of use to somebody who looks for a lost phone. */
function deviceName(words: string): string {
  const browser = named(words, [
    [/Edg/, "Edge"],
    [/Firefox|FxiOS/, "Firefox"],
    [/Chrome|CriOS/, "Chrome"],
    [/Safari/, "Safari"],
  ]);
  const system = named(words, [
    [/Android/, "Android"],
    [/iPhone/, "iPhone"],
    [/iPad/, "iPad"],
    [/Windows/, "Windows"],
    [/Mac OS/, "Mac"],
    [/Linux/, "Linux"],
  ]);
  return browser && system ? `${browser}, ${system}` : words.slice(0, 60);
}

export type Try = (doing: Promise<unknown>) => void;

function OwnSessions({ attempt, list }: { attempt: Try; list: access.OpenSession[] }) {
  return (
    <section>
      <div class="page-head">
        <h1>{t("people.sessions")}</h1>
        <button
          type="button"
          data-testid="sign-out-everywhere"
          onClick={() => attempt(access.signOutEverywhere().then(() => location.reload()))}
        >
          {t("people.signOutEverywhere")}
        </button>
      </div>
      <ul class="cards">
        {list.map((one) => (
          <li class="card person" key={one.session_id} data-testid="session">
            <div>
              <strong>{one.own ? t("people.thisDevice") : one.address}</strong>
              <div class="muted">
                {deviceName(one.device)} · {t("people.idle", { time: formatAge(one.idle_s) })}
              </div>
            </div>
            {!one.own && (
              <button type="button" data-testid="end-session" onClick={() => attempt(access.endSession(one.session_id))}>
                {t("people.signOut")}
              </button>
            )}
          </li>
        ))}
      </ul>
    </section>
  );
}

function Row({ person, attempt }: { person: access.Person; attempt: Try }) {
  const { person_id: id, role, admin, active, name } = person;
  const own = me.value?.person_id === id;
  const change = (to: Partial<{ role: access.Role; admin: boolean; active: boolean }>) =>
    attempt(access.changePerson(id, { role, admin, active, ...to }));
  return (
    <li class="card person" data-testid="person" data-name={name}>
      <div>
        <strong>{name}</strong> {own && <span class="muted">{t("people.you")}</span>}
        <div class="muted">{active ? t("people.openSessions", { count: person.sessions }) : t("people.shutOut")}</div>
      </div>
      <div class="person-acts">
        <RolePick value={role} label={t("people.roleOf", { name })} onPick={(to) => change({ role: to })} />
        <label class="check">
          <input type="checkbox" checked={admin} onChange={(e) => change({ admin: e.currentTarget.checked })} />
          {t("people.admin")}
        </label>
        <button type="button" disabled={person.sessions === 0} onClick={() => attempt(access.signPersonOut(id))}>
          {t("people.signOut")}
        </button>
        <button type="button" data-testid="shut-out" onClick={() => change({ active: !active })}>
          {t(active ? "people.shut" : "people.letIn")}
        </button>
      </div>
    </li>
  );
}

interface Listed {
  sessions: access.OpenSession[];
  people: access.Person[];
  invitations: access.Invitation[];
  tokens: access.Token[];
}

async function read(admin: boolean): Promise<Listed> {
  const { sessions } = await access.ownSessions();
  if (!admin) return { sessions, people: [], invitations: [], tokens: [] };
  const [{ people }, { invitations }, { tokens }] = await Promise.all([access.people(), access.invitations(), access.tokens()]);
  return { sessions, people, invitations, tokens };
}

function Alone() {
  return (
    <div class="page" data-testid="people-page">
      <h1>{t("menu.people")}</h1>
      <p>{t("people.alone")}</p>
      <p>{t("people.alone.how")}</p>
    </div>
  );
}

export function PeoplePage() {
  const [listed, setListed] = useState<Listed | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [sending, setSending] = useState(false);
  const admin = me.value?.admin ?? false;
  const alone = me.value === null;
  const fail = (error: unknown) => {
    setProblem(asProblem(error));
    void refreshSession();
  };
  const reload = () => (alone ? Promise.resolve() : read(admin).then(setListed, fail));
  const attempt: Try = (doing) => {
    setProblem(null);
    setSending(true); // what is shown is older than what was sent
    void doing
      .catch(fail)
      .then(reload)
      .then(() => setSending(false));
  };
  useEffect(() => {
    void reload();
  }, [admin, alone]);
  if (alone) return session.value === null ? null : <Alone />;
  return (
    <div class="page people" data-testid="people-page">
      {problem && <ProblemBox problem={problem} />}
      {listed && admin && (
        <>
          <section>
            <div class="page-head">
              <h1>{t("menu.people")}</h1>
            </div>
            <ul class="cards" data-testid="people" inert={sending}>
              {listed.people.map((person) => (
                <Row person={person} attempt={attempt} key={person.person_id} />
              ))}
            </ul>
          </section>
          <Invitations list={listed.invitations} sending={sending} attempt={attempt} />
          <Machines list={listed.tokens} attempt={attempt} />
        </>
      )}
      {listed && <OwnSessions list={listed.sessions} attempt={attempt} />}
      {listed && <OwnPassword onChanged={() => void reload()} />}
    </div>
  );
}
