import { t } from "../i18n";

/** What is entered is not kept: the browser's storage is full or blocked. */
export const NotStored = () => (
  <p class="field-message" role="alert" data-testid="not-stored">
    {t("edit.notStored")}
  </p>
);
