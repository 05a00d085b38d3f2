// Choosing, keeping and removing equipment profiles.
import { useState } from "preact/hooks";
import { t } from "../i18n";
import { draft, textBeside, update } from "./draft";
import { NotStored } from "./NotStored";
import { areStored, isSetBy, profileOf, profiles, readAgain, removeProfile, saveProfile, takeBack, withProfile } from "./profiles";

export function ProfileRow() {
  const [name, setName] = useState("");
  const known = profiles.value;
  const use = (chosen: string) => {
    readAgain();
    const now = draft.peek();
    const profile = profiles.peek().find((p) => p.name === chosen);
    setName(chosen);
    if (now && profile)
      update({ ...now, spec: withProfile(now.spec, profile), text: textBeside(now.text, (path) => isSetBy(profile, path)) });
  };
  const save = () => {
    const now = draft.peek();
    if (now && name.trim()) saveProfile(profileOf(now.spec, name.trim()));
  };
  return (
    <>
      {known.length > 0 && (
        <div class="field">
          <label for="profile">{t("edit.profile.use")}</label>
          <select id="profile" data-testid="profile" value="" onChange={(e) => use(e.currentTarget.value)}>
            <option value="">–</option>
            {known.map((p) => (
              <option value={p.name} key={p.name}>
                {p.name}
              </option>
            ))}
          </select>
        </div>
      )}
      <details class="more">
        <summary>{t("edit.profile.keep")}</summary>
        <p class="muted">{t("edit.profile.what")}</p>
        {!areStored.value && <NotStored />}
        <div class="area-row">
          <input
            aria-label={t("edit.profile.name")}
            placeholder={t("edit.profile.name")}
            data-testid="profile-name"
            value={name}
            onInput={(e) => setName(e.currentTarget.value)}
            onKeyDown={(e) => {
              if (e.key !== "Enter") return;
              e.preventDefault(); // would save the mission
              save();
            }}
          />
          <button type="button" data-testid="profile-save" disabled={name.trim() === ""} onClick={save}>
            {t("edit.profile.save")}
          </button>
          {(known.find((p) => p.name === name)?.history?.length ?? 0) > 0 && (
            <button type="button" data-testid="profile-back" onClick={() => takeBack(name)}>
              {t("edit.profile.back", { date: known.find((p) => p.name === name)!.history![0]!.at.slice(0, 10) })}
            </button>
          )}
          {known.some((p) => p.name === name) && (
            <button type="button" onClick={() => removeProfile(name)}>
              {t("edit.area.clear")}
            </button>
          )}
        </div>
      </details>
    </>
  );
}
