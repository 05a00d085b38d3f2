// German: requests to the server, its journal and its disk.
import type { ReasonTable } from "../reasons";

export const server = {
  field_missing: { text: "Das Feld fehlt.", remedy: "" },
  field_unknown: { text: "Dieses Feld gibt es nicht.", remedy: "" },
  field_out_of_range: {
    text: "Der Wert muss {relation?greater_than=größer als|greater_than_equal=mindestens|less_than=kleiner als|less_than_equal=höchstens} {bound} sein.",
    remedy: "",
  },
  field_wrong_length: {
    text: "Nötig sind {relation?least=mindestens|most=höchstens} {length|Zeichen oder Eintrag|Zeichen oder Einträge}.",
    remedy: "",
  },
  field_not_one_of: { text: "Erlaubt ist eines von {expected}.", remedy: "" },
  field_invalid: { text: "Das ist nicht gültig: {message}.", remedy: "" },
  request_invalid: {
    text: "So geht es nicht: {faults|Feld ist|Felder sind} falsch, zuerst {field}.",
    remedy: "Die genannten Felder berichtigen und noch einmal senden.",
  },
  nothing_there: {
    text: "Es gibt {what?mission=keine Mission|page=keine Seite|belief_about=keine Karte der Wahrscheinlichkeit für den Sender|belief_at=keine Karte der Wahrscheinlichkeit zum Ereignis|belief_after=keine Karte der Wahrscheinlichkeit nach so vielen Peilungen:|sweep=keine Drehung|map=keine Karte|overlay=keine Überlagerung|terrain=kein Gelände|file=keine Datei|recording=keine Aufnahme|craft=kein Fluggerät|scene=keine 3D-Ansicht|person=keine Person|session=keine Sitzung|invitation=keine Einladung|token=kein Token} {which}.",
    remedy: "Vielleicht wurde es gelöscht, oder der Name ist falsch geschrieben: Sehen Sie nach, was es gibt, und wählen Sie neu.",
  },
  iq_not_kept: {
    text: "Von dieser Mission wurde kein IQ behalten, nur die Leistung ihrer Drehungen.",
    remedy: "Behalten wird das IQ von SigMF-Aufnahmen, die importiert werden; für die Leistung, Messwert für Messwert, alles exportieren.",
  },
  http_refused: { text: "Die Anfrage wurde abgelehnt ({status}): {phrase}.", remedy: "" },
  body_too_large: {
    text: "Eine Anfrage darf höchstens {most_bytes} haben.",
    remedy: "Die Geometrie vereinfachen oder die Datei teilen.",
  },
  stock_full: {
    text: "Dafür ist kein Platz: Höchstens {most} {what?overlays=Überlagerungen|recordings=rohe Drehungen aus Aufnahmen} und {most_bytes} davon werden behalten.",
    remedy:
      "{what?overlays=Überlagerungen löschen, die nicht gebraucht werden, oder CROSSFIX_OVERLAYS_MAX und CROSSFIX_OVERLAYS_MAX_BYTES erhöhen|recordings=Rohe Drehungen alter Missionen löschen lassen (crossfix thin) oder CROSSFIX_RECORDINGS_MAX_SWEEPS und CROSSFIX_RECORDINGS_MAX_BYTES erhöhen}.",
  },
  body_too_rich: {
    text: "Eine Anfrage darf höchstens {most_fields} benannte Felder und {most_items} Listeneinträge haben.",
    remedy: "Die Geometrie vereinfachen.",
  },
  body_too_slow: {
    text: "{wait_s} lang kam nichts von der Anfrage an.",
    remedy: "Das Netz prüfen, dann noch einmal senden.",
  },
  unknown_host: {
    text: "Dieser Server heißt nicht {host}.",
    remedy: "Ihn über seine IP-Adresse oder localhost öffnen oder den Namen in CROSSFIX_ALLOWED_HOSTS nennen.",
  },
  foreign_origin: {
    text: "Eine Seite von {origin} darf diesem Server nichts befehlen.",
    remedy: "Die Seite benutzen, die dieser Server ausliefert.",
  },
  samples_not_stored: {
    text: "Die Messwerte von Ort {place_number} wurden nicht gespeichert; darum kann keine andere Antenne sie hören.",
    remedy: "Mit anderem Peilfehler, Ausreißeranteil oder Planer fragen: Diese brauchen keine Messwerte.",
  },
  export_unreadable: {
    text: "{fault?not_json=Das ist kein JSON|not_exported=Das ist keine von Crossfix ausgegebene Mission|later=Das wurde von einem neueren Crossfix ausgegeben}.",
    remedy: "{fault?later=Mit jenem Crossfix öffnen.|*=Die Datei mission.json einer ausgegebenen Mission wählen.}",
  },
  bundle_unreadable: {
    text: "{fault?not_zip=Das ist keine ZIP-Datei|too_large=Die Dateien im Bündel sind größer als die jeder Mission|later=Dieses Bündel hat ein neueres Crossfix geschrieben|under_way=Die Mission lief noch, als das Bündel geschrieben wurde|differs=Dieselbe Mission gibt es hier schon, mit anderen Ereignissen}.",
    remedy:
      "{fault?later=Mit jenem Crossfix öffnen.|under_way=Nach ihrem Ende noch einmal mitnehmen.|differs=Nichts wurde geändert. Die Mission öffnen, die hier ist.|*=Die ZIP-Datei wählen, die „Alles“ beim Mitnehmen speichert, unverändert.}",
  },
  bundle_file_wrong: {
    text: "{fault?foreign=Eine solche Datei schreibt Crossfix nicht in ein Bündel|damaged=Eine Datei im Bündel ist beschädigt|not_exported=Eine Datei im Bündel stammt nicht von Crossfix}: {name}.",
    remedy: "Die ZIP-Datei wählen, die „Alles“ beim Mitnehmen speichert, unverändert.",
  },
  upload_broke_off: {
    text: "Das Hochladen brach ab; nichts wurde behalten.",
    remedy: "Die Datei noch einmal hochladen.",
  },
  no_payload_expected: {
    text: "Dieser Server nimmt keine Messwerte von einer Nutzlast an.",
    remedy: "Ihn mit CROSSFIX_PAYLOAD_TOKENS starten, einer Liste der Tokens, die seine Nutzlasten zeigen dürfen.",
  },
  unknown_token: {
    text: "Der Server kennt dieses Token nicht, oder es gilt nicht mehr.",
    remedy: "Vom Admin ein neues geben lassen oder für eine Nutzlast eines aus CROSSFIX_PAYLOAD_TOKENS nehmen.",
  },
  too_many_scenes: { text: "Zu viele 3D-Ansichten sind offen.", remedy: "Eine in einem anderen Tab schließen." },
  scene_silent: { text: "Der 3D-Server antwortet nicht.", remedy: "Die Ansicht neu laden." },
  server_broke: {
    text: "Wegen eines Fehlers im Server war die Anfrage nicht auszuführen (Vorfall {incident}).",
    remedy: "Die Mission geht weiter. Noch einmal versuchen; geschieht es wieder, den Vorfall mit dem Protokoll des Servers melden.",
  },

  database_silent: {
    text: "Die Datenbank antwortet nicht: {detail}.",
    remedy:
      "Prüfen, ob sie läuft und ihre Platte Platz hat und beschreibbar ist; was inzwischen geschieht, liegt in der Warteschlange auf der Platte.",
  },
  database_slow: {
    text: "Die letzte Antwort der Datenbank dauerte {answer_s:1}.",
    remedy: "Nach ihrer Last und ihrer Platte sehen.",
  },
  machine_busy: {
    text: "Der Rechner des Servers ist so ausgelastet, dass Antworten der Datenbank zu spät ankommen.",
    remedy: "Anderes auf diesem Rechner beenden; was inzwischen geschieht, liegt in der Warteschlange auf der Platte.",
  },
  database_taken: {
    text: "Etwas anderes schreibt gerade in die Datei der Datenbank.",
    remedy:
      "Das geht von selbst vorüber, etwa wenn ein Bündel hereingeholt wird; sonst das andere Programm beenden. Was inzwischen geschieht, liegt in der Warteschlange auf der Platte.",
  },
  disk_busy: {
    text: "Die Platte ist so langsam, dass Antworten der Datenbank zu spät kommen.",
    remedy: "Anderes beenden, das diese Platte beschäftigt; was inzwischen geschieht, liegt dort in der Warteschlange.",
  },
  disk_low: { text: "Auf der Platte sind nur noch {free_bytes} frei.", remedy: "Platz schaffen." },
  nothing_stores: {
    text: "Die Datenbank nimmt nichts an ({database}), und die Warteschlange ist nicht beschreibbar ({spool}).",
    remedy: "Auf der Platte Platz schaffen und die Datenbank wieder starten.",
  },
  fact_unfit: {
    text: "{by?journal=Das ergibt keinen Sinn und lässt sich nicht speichern|database=Die Datenbank lehnt das ab}: {detail}.",
    remedy: "",
  },
  written_elsewhere: {
    text: "Ereignis {seq} der Mission {mission_id} schließt nicht an das Gespeicherte an: Ein anderer Server schreibt hinein.",
    remedy: "Nur einen Server diese Datenbank benutzen lassen.",
  },
  mission_damaged: {
    text: "Was von der Mission {mission_id} gespeichert ist, ist beschädigt und nicht lesbar: {detail}.",
    remedy:
      "Die anderen Missionen betrifft das nicht; eine Sicherung enthält diese vielleicht noch ganz. In der Liste lässt sie sich löschen.",
  },
  database_later: {
    text: "Ein neueres Crossfix hat die Datenbank {database} geschrieben (Schema {revision}).",
    remedy: "Dieses hier aktualisieren oder eine Sicherung von vor der Aktualisierung wiederherstellen.",
  },
  database_unfit: {
    text: "Die Datenbank {database} ist nicht verwendbar: {detail}.",
    remedy: "Prüfen, ob --data-dir und CROSSFIX_DATABASE_URL stimmen und die Platte beschreibbar ist und Platz hat.",
  },
  another_server: {
    text: "Ein anderer Server benutzt {path}.",
    remedy: "Ihn beenden oder diesen mit einem anderen --data-dir starten.",
  },
  foreign_spool: {
    text: "Unter {path} liegt keine Warteschlange des Journals.",
    remedy: "Das Verzeichnis wegräumen und noch einmal starten.",
  },
} satisfies Partial<ReasonTable>;
