// Who may enter: sessions, people, invitations, machines' tokens.
import type { components } from "../wire/generated";
import { json, requestEmpty, withBody } from "./api";

type Schemas = components["schemas"];
export type SessionState = Schemas["SessionState"];
export type SignedIn = Schemas["SignedIn"];
export type Role = SignedIn["role"];
export type OpenSession = Schemas["OpenSession"];
export type Person = Schemas["Person"];
export type Invitation = Schemas["Invitation"];
export type InvitationOffer = Schemas["InvitationOffer"];
export type MadeInvitation = Schemas["MadeInvitation"];
export type Token = Schemas["Token"];
export type MadeToken = Schemas["MadeToken"];
export type Scope = Token["scope"];

const remove = (path: string) => requestEmpty(path, { method: "DELETE" });

export const session = () => json<SessionState>("/session");
export const signIn = (name: string, password: string) => json<SessionState>("/session", withBody("POST", { name, password }));
export const signOut = () => remove("/session");
export const makeFirstAdmin = (code: string, name: string, password: string) =>
  json<SessionState>("/first-admin", withBody("POST", { code, name, password }));
export const lookAtInvitation = (code: string) => json<InvitationOffer>("/invitation/look", withBody("POST", { code }));
export const acceptInvitation = (code: string, name: string, password: string) =>
  json<SessionState>("/invitation/accept", withBody("POST", { code, name, password }));
export const recover = (code: string, password: string) => json<SessionState>("/recovery", withBody("POST", { code, password }));
/** A navigation: the browser leaves for the provider, and comes back to this page. */
export const providerAddress = "/api/provider/begin";

export const ownSessions = () => json<{ sessions: OpenSession[] }>("/account/sessions");
export const endSession = (id: string) => remove(`/account/sessions/${id}`);
export const signOutEverywhere = () => remove("/account/sessions");
export const changePassword = (old: string, next: string) => requestEmpty("/account/password", withBody("PUT", { old, new: next }));

export const people = () => json<{ people: Person[] }>("/people");
export const changePerson = (id: string, to: { role: Role; admin: boolean; active: boolean }) =>
  json<Person>(`/people/${id}`, withBody("PUT", to));
export const signPersonOut = (id: string) => remove(`/people/${id}/sessions`);
export const invitations = () => json<{ invitations: Invitation[] }>("/invitations");
export const invite = (role: Role, admin: boolean, hours: number) =>
  json<MadeInvitation>("/invitations", withBody("POST", { role, admin, hours }));
export const takeBackInvitation = (id: string) => remove(`/invitations/${id}`);
export const tokens = () => json<{ tokens: Token[] }>("/tokens");
export const makeToken = (name: string, scope: Scope) => json<MadeToken>("/tokens", withBody("POST", { name, scope, days: null }));
export const revokeToken = (id: string) => remove(`/tokens/${id}`);
