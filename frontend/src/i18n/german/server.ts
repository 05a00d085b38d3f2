// German: requests to the server, its journal and its disk.
import type { ReasonTable } from "../reasons";

export const server = {
  field_missing: ["Das Feld fehlt."],
  field_unknown: ["Dieses Feld gibt es nicht."],
  field_out_of_range: [
    "Der Wert muss {relation?greater_than=größer als|greater_than_equal=mindestens|less_than=kleiner als|less_than_equal=höchstens} {bound} sein.",
  ],
  field_wrong_length: ["Nötig sind {relation?least=mindestens|most=höchstens} {length|Zeichen oder Eintrag|Zeichen oder Einträge}."],
  field_not_one_of: ["Erlaubt ist eines von {expected}."],
  field_invalid: ["Das ist nicht gültig: {message}."],
  request_invalid: [
    "So geht es nicht: {faults|Feld ist|Felder sind} falsch, zuerst {field}.",
    "Die genannten Felder berichtigen und noch einmal senden.",
  ],
  nothing_there: [
    "Es gibt {what?mission=keine Mission|page=keine Seite|belief_about=keine Karte der Wahrscheinlichkeit für den Sender|belief_at=keine Karte der Wahrscheinlichkeit zum Ereignis|belief_after=keine Karte der Wahrscheinlichkeit nach so vielen Peilungen:|sweep=keine Drehung|map=keine Karte|overlay=keine Überlagerung|terrain=kein Gelände|file=keine Datei|recording=keine Aufnahme|craft=kein Fluggerät|scene=keine 3D-Ansicht|person=keine Person|session=keine Sitzung|invitation=keine Einladung|token=kein Token} {which}.",
    "Vielleicht wurde es gelöscht, oder der Name ist falsch geschrieben: Sehen Sie nach, was es gibt, und wählen Sie neu.",
  ],
  iq_not_kept: [
    "Von dieser Mission wurde kein IQ behalten, nur die Leistung ihrer Drehungen.",
    "Behalten wird das IQ von SigMF-Aufnahmen, die importiert werden; für die Leistung, Messwert für Messwert, alles exportieren.",
  ],
  http_refused: ["Die Anfrage wurde abgelehnt ({status}): {phrase}."],
  body_too_large: [
    "{what?mission=Die Datei einer Mission|other=Eine Anfrage} darf höchstens {most_bytes} haben.",
    "{what?mission=Die ZIP-Datei wählen, die „Alles“ beim Mitnehmen speichert: Sie ist gepackt. Ist es diese, dann ist die Mission länger als jede, die gelesen werden kann.|other=Die Geometrie vereinfachen oder die Datei teilen.}",
  ],
  stock_full: [
    "Dafür ist kein Platz: Höchstens {most} {what?overlays=Überlagerungen|recordings=rohe Drehungen aus Aufnahmen} und {most_bytes} davon werden behalten.",
    "{what?overlays=Überlagerungen löschen, die nicht gebraucht werden, oder CROSSFIX_OVERLAYS_MAX und CROSSFIX_OVERLAYS_MAX_BYTES erhöhen|recordings=Rohe Drehungen alter Missionen löschen lassen (crossfix thin) oder CROSSFIX_RECORDINGS_MAX_SWEEPS und CROSSFIX_RECORDINGS_MAX_BYTES erhöhen}.",
  ],
  body_too_rich: [
    "Eine Anfrage darf höchstens {most_fields} benannte Felder und {most_items} Listeneinträge haben.",
    "Die Geometrie vereinfachen.",
  ],
  body_too_slow: ["{wait_s} lang kam nichts von der Anfrage an.", "Das Netz prüfen, dann noch einmal senden."],
  unknown_host: [
    "Dieser Server heißt nicht {host}.",
    "Ihn über seine IP-Adresse oder localhost öffnen oder den Namen in CROSSFIX_ALLOWED_HOSTS nennen.",
  ],
  foreign_origin: ["Eine Seite von {origin} darf diesem Server nichts befehlen.", "Die Seite benutzen, die dieser Server ausliefert."],
  samples_not_stored: [
    "Die Messwerte von Ort {place_number} wurden nicht gespeichert; darum kann keine andere Antenne sie hören.",
    "Mit anderem Peilfehler, Ausreißeranteil oder Planer fragen: Diese brauchen keine Messwerte.",
  ],
  export_unreadable: [
    "{fault?not_json=Das ist kein JSON|not_exported=Das ist keine von Crossfix ausgegebene Mission|later=Das wurde von einem neueren Crossfix ausgegeben}.",
    "{fault?later=Mit jenem Crossfix öffnen.|*=Die Datei mission.json einer ausgegebenen Mission wählen.}",
  ],
  bundle_unreadable: [
    "{fault?not_zip=Das ist keine ZIP-Datei|too_large=Die Dateien im Bündel sind größer als die jeder Mission|later=Dieses Bündel hat ein neueres Crossfix geschrieben|under_way=Die Mission lief noch, als das Bündel geschrieben wurde|differs=Dieselbe Mission gibt es hier schon, mit anderen Ereignissen}.",
    "{fault?later=Mit jenem Crossfix öffnen.|under_way=Nach ihrem Ende noch einmal mitnehmen.|differs=Nichts wurde geändert. Die Mission öffnen, die hier ist.|*=Die ZIP-Datei wählen, die „Alles“ beim Mitnehmen speichert, unverändert.}",
  ],
  bundle_file_wrong: [
    "{fault?foreign=Eine solche Datei schreibt Crossfix nicht in ein Bündel|damaged=Eine Datei im Bündel ist beschädigt|not_exported=Eine Datei im Bündel stammt nicht von Crossfix}: {name}.",
    "Die ZIP-Datei wählen, die „Alles“ beim Mitnehmen speichert, unverändert.",
  ],
  bundle_fact_wrong: [
    "Ereignis {seq} in der mission.json des Bündels {fault?place=nennt eine Schätzung, die kein Ort auf der Erde ist|region=nennt ein 95-%-Gebiet, das keine Fläche ist|spread=nennt eine Unsicherheit oder Zahl, die es nicht geben kann|unknown_bearing=lässt eine Peilung aus oder zählt sie wieder mit, die es nicht gibt|bearing_twice=nennt eine Peilung mit der Kennung einer anderen|not_started=handelt von einem Fluggerät, das nicht gestartet war|name=gibt einen Namen mit Zeichen, die die Schreibrichtung umkehren|id=nennt eine Drehung mit Zeichen, die keine Kennung hat}.",
    "Nichts wurde übernommen. Die ZIP-Datei wählen, die „Alles“ beim Mitnehmen speichert, unverändert.",
  ],
  upload_broke_off: ["Das Hochladen brach ab; nichts wurde behalten.", "Die Datei noch einmal hochladen."],
  no_payload_expected: [
    "Dieser Server nimmt keine Messwerte von einer Nutzlast an.",
    "Ihn mit CROSSFIX_PAYLOAD_TOKENS starten, einer Liste der Tokens, die seine Nutzlasten zeigen dürfen.",
  ],
  unknown_token: [
    "Der Server kennt dieses Token nicht, oder es gilt nicht mehr.",
    "Vom Admin ein neues geben lassen oder für eine Nutzlast eines aus CROSSFIX_PAYLOAD_TOKENS nehmen.",
  ],
  too_many_scenes: ["Zu viele 3D-Ansichten sind offen.", "Eine in einem anderen Tab schließen."],
  scene_silent: ["Der 3D-Server antwortet nicht.", "Die Ansicht neu laden."],
  server_broke: [
    "Wegen eines Fehlers im Server war die Anfrage nicht auszuführen (Vorfall {incident}).",
    "Die Mission geht weiter. Noch einmal versuchen; geschieht es wieder, den Vorfall mit dem Protokoll des Servers melden.",
  ],

  database_silent: [
    "Die Datenbank antwortet nicht: {detail}.",
    "Prüfen, ob sie läuft und ihre Platte Platz hat und beschreibbar ist; was inzwischen geschieht, liegt in der Warteschlange auf der Platte.",
  ],
  database_slow: ["Die letzte Antwort der Datenbank dauerte {answer_s:1}.", "Nach ihrer Last und ihrer Platte sehen."],
  machine_busy: [
    "Der Rechner des Servers ist so ausgelastet, dass Antworten der Datenbank zu spät ankommen.",
    "Anderes auf diesem Rechner beenden; was inzwischen geschieht, liegt in der Warteschlange auf der Platte.",
  ],
  database_taken: [
    "Etwas anderes schreibt gerade in die Datei der Datenbank.",
    "Das geht von selbst vorüber, etwa wenn ein Bündel hereingeholt wird; sonst das andere Programm beenden. Was inzwischen geschieht, liegt in der Warteschlange auf der Platte.",
  ],
  disk_busy: [
    "Die Platte ist so langsam, dass Antworten der Datenbank zu spät kommen.",
    "Anderes beenden, das diese Platte beschäftigt; was inzwischen geschieht, liegt dort in der Warteschlange.",
  ],
  disk_low: ["Auf der Platte sind nur noch {free_bytes} frei.", "Platz schaffen."],
  nothing_stores: [
    "Die Datenbank nimmt nichts an ({database}), und die Warteschlange ist nicht beschreibbar ({spool}).",
    "Auf der Platte Platz schaffen und die Datenbank wieder starten.",
  ],
  fact_unfit: ["{by?journal=Das ergibt keinen Sinn und lässt sich nicht speichern|database=Die Datenbank lehnt das ab}: {detail}."],
  written_elsewhere: [
    "Ereignis {seq} der Mission {mission_id} schließt nicht an das Gespeicherte an: Ein anderer Server schreibt hinein.",
    "Nur einen Server diese Datenbank benutzen lassen.",
  ],
  mission_damaged: [
    "Was von der Mission {mission_id} gespeichert ist, ist beschädigt und nicht lesbar: {detail}.",
    "Die anderen Missionen betrifft das nicht; eine Sicherung enthält diese vielleicht noch ganz. In der Liste lässt sie sich löschen.",
  ],
  database_later: [
    "Ein neueres Crossfix hat die Datenbank {database} geschrieben (Schema {revision}).",
    "Dieses hier aktualisieren oder eine Sicherung von vor der Aktualisierung wiederherstellen.",
  ],
  database_unfit: [
    "Die Datenbank {database} ist nicht verwendbar: {detail}.",
    "Prüfen, ob --data-dir und CROSSFIX_DATABASE_URL stimmen und die Platte beschreibbar ist und Platz hat.",
  ],
  another_server: ["Ein anderer Server benutzt {path}.", "Ihn beenden oder diesen mit einem anderen --data-dir starten."],
  foreign_spool: ["Unter {path} liegt keine Warteschlange des Journals.", "Das Verzeichnis wegräumen und noch einmal starten."],
} satisfies Partial<ReasonTable>;
