// German: files with sweeps, tables and SigMF recordings.
import type { ReasonTable } from "../reasons";

const FIELD_REMEDY =
  "{field?core:sample_rate=Die Abtastwerte in der Sekunde nennen, eine Zahl größer als null" +
  "|core:frequency=Eine Mittenfrequenz in Hertz nennen; eine Aufnahme, die umgestimmt wurde, in eine je Frequenz zerschneiden" +
  "|core:datetime=Den Beginn der Aufnahme nennen wie in 2026-05-01T10:00:00Z oder die Zeiten der Kurse als Sekunden seitdem schreiben" +
  "|core:geolocation=Einen GeoJSON-Punkt auf der Erde nennen oder das Feld weglassen" +
  "|core:dataset=Es entfernen und die .sigmf-data-Datei wie die .sigmf-meta-Datei nennen" +
  "|antenna:azimuth_angle=In mindestens zwei Anmerkungen nennen, wohin die Antenne zeigte (in Grad), oder eine Tabelle mit Zeit und Kurs neben der Aufnahme angeben}.";

export const recording = {
  file_unreadable: { text: "Die Datei {file} ist nicht lesbar ({detail}).", remedy: "Ihren Pfad und ihr Format prüfen." },
  file_unusable: {
    text: "Die Datei {file} {why?not_text=ist keine Textdatei|empty=enthält keine Zeilen mit Daten|no_pulse=enthält keinen Puls (keine Zeile, die mit 7 beginnt)|one_heading=enthält weniger als zwei Zeilen mit Zeit und Kurs}.",
    remedy: "{why?not_text=Die Aufnahme als CSV ausgeben|*=Prüfen, ob es die richtige Datei ist}.",
  },
  columns_unknown: {
    text: "Die {columns|Spalte|Spalten} von {file} (Zeile {line}) {columns?1=ist|*=sind} nicht zu unterscheiden.",
    remedy: "Sie in einer Kopfzeile nennen: {expected}.",
  },
  too_many_cells: {
    text: "Zeile {line} von {file} hat {cells|Zelle|Zellen} für {columns|Spalte|Spalten}.",
    remedy: "Bei Dezimalkommas die Spalten mit Semikolons trennen; sonst jede Spalte nennen.",
  },
  cell_unusable: {
    text: "Zeile {line} von {file} ist ausgelassen: „{cell}“ in Spalte {column} ist {quantity?latitude=keine brauchbare Breite|longitude=keine brauchbare Länge|bearing=keine brauchbare Peilung|sigma=kein brauchbarer Peilfehler|time=keine brauchbare Zeit|heading=kein brauchbarer Kurs|power=keine brauchbare Leistung|frequency=keine brauchbare Frequenz|snr=kein brauchbares SNR|attitude=keine brauchbare Lage|noise_psd=keine brauchbare Rauschdichte|kind_of_row=keine Zeilenart (7, 10 oder 11)}.",
    remedy: "",
  },
  row_left_out: {
    text: "Zeile {line} von {file} ist ausgelassen: {why?columns=Sie hat zu wenige Spalten|not_open=Sie beendet eine Drehung, die nie begann|two_offsets=Die Spalten 20 und 21 nennen beide einen Antennenversatz|wide=Sie hat mehr Zahlen, als es Spalten gibt}.",
    remedy:
      "{why?two_offsets=Eine Kopfzeile ergänzen, die den richtigen nennt.|wide=Bei Dezimalkommas die Spalten mit Semikolons trennen; sonst jede Spalte nennen.|*=}",
  },
  rotation_irregular: {
    text: "Die Drehung ab Zeile {line} von {file} {why?empty=enthält keinen brauchbaren Puls und ist ausgelassen|not_closed=wird nie beendet (keine Zeile 11); sie endet, wo die nächste beginnt, oder mit der Datei|offset_changes=wechselt ihren Antennenversatz; der häufigste wird verwendet}.",
    remedy: "",
  },
  pulses_outside_rotations: { text: "Aus {file} ausgelassen: {pulses|Puls|Pulse} außerhalb jeder Drehung.", remedy: "" },
  tag_not_heard: {
    text: "Die Kennung {tag} war in der Drehung ab Zeile {line} von {file} nicht zu hören.",
    remedy: "Eine ihrer Kennungen wählen: {heard}.",
  },
  one_tag_only: { text: "{file} enthält Peilungen der Kennungen {tags}.", remedy: "Eine davon nennen." },
  remarks_not_listed: { text: "{remarks|weitere Anmerkung|weitere Anmerkungen} zu {file}: nicht einzeln aufgeführt.", remedy: "" },
  other_tags_left_out: {
    text: "Aus der Drehung ab Zeile {line} von {file} wird die Kennung {tag} verwendet, ohne {pulses|Puls|Pulse} anderer Kennungen ({others}).",
    remedy: "Um eine andere Kennung zu verwenden, sie nennen.",
  },
  decibels_assumed: {
    text: "Die Leistung von {file} wird als Dezibel genommen.",
    remedy: "Stimmt das, die Spalte power_db nennen.",
  },
  places_apart: {
    text: "Die Drehung ab Zeile {line} von {file} entstand an Orten, die {apart_m} auseinanderliegen.",
    remedy: "Mehrere Drehungen in einer Spalte namens sweep nummerieren.",
  },
  headings_in_radians: {
    text: "Die Kurse von {file} scheinen Radiant zu sein.",
    remedy: "Grad schreiben.",
  },
  power_linear: {
    text: "Die Leistung von {file} ist {by?name=dem Namen|values=den Werten} nach linear.",
    remedy: "Dezibel schreiben und die Spalte power_db nennen.",
  },
  nothing_usable: {
    text: "Die Datei {file} enthält {wanted?bearing=keine brauchbare Peilung|power=keine brauchbare Zeile mit Kurs und Leistung|pulse=keinen brauchbaren Puls}. {because}",
    remedy:
      "{wanted?bearing=Die Spalten lat, lon, bearing_deg und, wenn bekannt, sigma_deg nennen.|power=Die Spalten heading_deg und power_db nennen.|pulse=Prüfen, ob es die richtige Datei ist.}",
  },
  place_not_stated: {
    text: "Die Datei {file} sagt nicht, wo aufgenommen wurde.",
    remedy: "Die Spalten lat und lon ergänzen oder den Ort daneben nennen.",
  },

  sigmf_field_missing: { text: "Die Aufnahme {file} nennt {field} nicht.", remedy: FIELD_REMEDY },
  sigmf_field_unusable: { text: "In der Aufnahme {file} ist {field} nicht verwendbar: {value}.", remedy: FIELD_REMEDY },
  sigmf_file_missing: {
    text: "Der Aufnahme {file} fehlt ihre Datei {missing}.",
    remedy: "Eine Aufnahme sind zwei Dateien: .sigmf-meta sagt, wie abgetastet wurde, .sigmf-data enthält die Abtastwerte.",
  },
  samples_unusable: {
    text: "Die Aufnahme {file} {why?collection=ist eine Sammlung von mehreren|real=enthält reelle Abtastwerte, kein komplexes IQ|none=enthält keinen Abtastwert|zero=ist stumm: Jeder Abtastwert ist null|too_short=ist zu kurz für einen Messwert}.",
    remedy:
      "{why?collection=Eine einzelne Aufnahme angeben|real=Komplexes IQ aufnehmen|none=Prüfen, ob ihre Datendatei vollständig ist|zero=Prüfen, ob der Empfänger lief|too_short=Ihre Abtastrate prüfen}.",
  },
  samples_not_numbers: {
    text: "In der Aufnahme {file} {samples?1=ist|*=sind} {samples|Abtastwert keine Zahl|Abtastwerte keine Zahlen}, der erste nach {first_s:2}.",
    remedy: "Sie herausschneiden oder core:datatype prüfen.",
  },
  no_signal_found: {
    text: "Die Aufnahme {file} ist stumm: Nichts liegt {needed_db:0} über dem Rauschen.",
    remedy: "Ist der Sender schwächer, seine Frequenz nennen.",
  },
  silent_at: {
    text: "Die Aufnahme {file} ist auf {frequency_hz} stumm: Der stärkste Messwert liegt {above_db} über dem Rauschen.",
    remedy: "Die Frequenz prüfen.",
  },
  no_pulse_at: {
    text: "Auf {frequency_hz} war in der Aufnahme {file} kein Puls zu hören.",
    remedy: "Die Frequenz sowie Pulsbreite und Periode des Senders prüfen.",
  },
  headings_apart: {
    text: "Die Kurse reichen von {from_s:1} bis {to_s:1} nach Beginn der Aufnahme {file}, die Abtastwerte nur bis {samples_s:1}.",
    remedy: "Die Zeiten und die Abtastrate ({sample_rate_hz}) prüfen.",
  },
  headings_of_other_length: {
    text: "Die Kurse von {file} dauern {headings_s:1}, die Abtastwerte {samples_s:1}; verwendet wird, was sie gemeinsam haben.",
    remedy: "Die Abtastrate der Aufnahme ({sample_rate_hz}) prüfen.",
  },
  strongest_used: {
    text: "Verwendet wird das stärkste Signal der Aufnahme {file}, auf {frequency_hz}.",
    remedy: "Um ein anderes Signal zu verwenden, seine Frequenz nennen.",
  },
  readings_without_heading: {
    text: "Aus der Aufnahme {file} ausgelassen, weil ihr Kurs nicht bekannt ist: {left_out} von {readings|Messwert|Messwerten}.",
    remedy: "",
  },
  not_iq: {
    text: "Die Datei {file} enthält {given?headings=ihre eigenen Kurse und kein IQ, das eine Tabelle davon braucht|signal=Leistungen, kein IQ; darum werden darin weder Frequenz noch Pulse gesucht}.",
    remedy: "{given?headings=Die Tabelle der Kurse weglassen.|signal=}",
  },
  recording_unusable: { text: "Die Aufnahme {file} ist nicht verwendbar. {because}", remedy: "{because!remedy}" },

  recording_too_long: { text: "Die Aufnahme enthält {sweeps} Drehungen.", remedy: "Höchstens {most} auf einmal einlesen." },
  asked_from_too_far: {
    text: "Von hier sind es {distance_m} bis zum Suchgebiet: zu weit für einen Rat, wo zu hören ist.",
    remedy: "Näher herangehen, oder sagen, von wo aus gesucht wird.",
  },
  kraken_unreadable: {
    text: "Das ist keine Peilung eines KrakenSDR: {what}.",
    remedy: "Den Text seiner DOA_value.html senden, mit dem Ausgabeformat „Kraken App“ geschrieben.",
  },
  heard_elsewhere: {
    text: "Die Peilung wurde auf {frequency_hz} gehört, dort wird nichts gesucht.",
    remedy: "Die Station auf eine Frequenz der Suche abstimmen.",
  },
  bearing_too_far: {
    text: "Die Peilung wurde {distance_m} vom Suchgebiet entfernt genommen.",
    remedy: "Prüfen, wo man steht, oder sie der Suche melden, zu der sie gehört.",
  },
  bearing_time_impossible: {
    text: "Die Zeit der Peilung liegt in der Zukunft oder mehr als einen Tag zurück.",
    remedy: "Die Uhr des Geräts stellen, das sie gesendet hat.",
  },
  which_emitter: {
    text: "Die Suche hat {emitters} Sender; die Peilung sagt nicht, welcher gehört wurde.",
    remedy: "Den Sender nennen.",
  },
  taken_earlier: { text: "Sie wurde {age_s} vor ihrem Eintreffen genommen.", remedy: "" },
  recording_too_far: {
    text: "Die Aufnahme entstand {distance_m} vom Gebiet der Mission entfernt.",
    remedy: "In eine Mission einlesen, deren Gebiet sie umgibt, oder den richtigen Ort nennen.",
  },
  import_remark: {
    text: "{about?place_replaced=Der genannte Ort ersetzt den aus der Datei|altitude_unknown=0 m über dem Meer wird vermerkt, denn keine Höhe nennt die Datei|bearings_stand=Der genannte Ort oder die Antenne ändert nichts an den Peilungen in der Datei} {file}.",
    remedy: "",
  },
  other_frequency: {
    text: "Die Datei {file} wurde auf {recorded_hz} aufgenommen; die Mission sucht {wanted_hz}.",
    remedy: "",
  },
  half_given: {
    text: "{pair?place=Ein Ort braucht Breite und Länge|pulses=Ein pulsender Sender braucht Pulsbreite und Periode}.",
    remedy: "Beide nennen oder keines von beiden.",
  },
  too_many_files: {
    text: "{files|Datei ist|Dateien sind} mehr als eine Aufnahme.",
    remedy: "Eine Datei hochladen oder Meta, Daten und Kurse.",
  },
  two_recordings: { text: "Die Dateien {first} und {second} sind zwei Aufnahmen.", remedy: "Sie nacheinander hochladen." },
} satisfies Partial<ReasonTable>;
