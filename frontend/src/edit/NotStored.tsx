import { t } from "../i18n";

/** Where what is entered is kept in the browser. */
export const NotStored = () => (
  <p class="field-message" role="alert" data-testid="not-stored">
    {t("edit.notStored")}
  </p>
);
