// German: files with sweeps, tables and SigMF recordings.
import type { ReasonTable } from "../reasons";

const FIELD_REMEDY =
  "{field?core:sample_rate=Die Abtastwerte in der Sekunde nennen, eine Zahl größer als null" +
  "|core:frequency=Eine Mittenfrequenz in Hertz nennen; eine Aufnahme, die umgestimmt wurde, in eine je Frequenz zerschneiden" +
  "|core:datetime=Den Beginn der Aufnahme nennen wie in 2026-05-01T10:00:00Z oder die Zeiten der Kurse als Sekunden seitdem schreiben" +
  "|core:geolocation=Einen GeoJSON-Punkt auf der Erde nennen oder das Feld weglassen" +
  "|core:dataset=Es entfernen und die .sigmf-data-Datei wie die .sigmf-meta-Datei nennen" +
  "|core:num_channels=Angeben, aus wie vielen Kanälen die Abtastwerte sind, mindestens einem, oder es weglassen" +
  "|antenna:azimuth_angle=In mindestens zwei Anmerkungen nennen, wohin die Antenne zeigte (in Grad), oder eine Tabelle mit Zeit und Kurs neben der Aufnahme angeben}.";

export const recording = {
  file_unreadable: ["Die Datei {file} ist nicht lesbar ({detail}).", "Ihren Pfad und ihr Format prüfen."],
  file_unusable: [
    "Die Datei {file} {why?not_text=ist keine Textdatei|empty=enthält keine Zeilen mit Daten|no_pulse=enthält keinen Puls (keine Zeile, die mit 7 beginnt)|one_heading=enthält weniger als zwei Zeilen mit Zeit und Kurs|sweeps=enthält Drehungen, keine Peilungen}.",
    "{why?not_text=Die Aufnahme als CSV ausgeben|sweeps=Mit crossfix sweep lesen oder keine Leistung nennen|*=Prüfen, ob es die richtige Datei ist}.",
  ],
  columns_unknown: [
    "Die {columns|Spalte|Spalten} von {file} (Zeile {line}) {columns?1=ist|*=sind} nicht zu unterscheiden.",
    "Sie in einer Kopfzeile nennen: {expected}.",
  ],
  columns_alike: [
    "Die Spalten {column} („{name}“) und {other} („{other_name}“) von {file} (Zeile {line}) heißen gleich.",
    "Die umbenennen, die nicht gemeint ist.",
  ],
  too_many_cells: [
    "Zeile {line} von {file} hat {cells|Zelle|Zellen} für {columns|Spalte|Spalten}.",
    "Haben Zahlen ein Dezimalkomma, die Spalten mit Semikolons trennen; sonst jede Spalte in einer Kopfzeile nennen.",
  ],
  cell_unusable: [
    "Zeile {line} von {file} ist ausgelassen: „{cell}“ in Spalte {column} ist {quantity?latitude=keine brauchbare Breite|longitude=keine brauchbare Länge|utm=kein brauchbarer UTM-Wert (Zone 22N, oder 22 neben einer Spalte hemisphere)|bearing=keine brauchbare Peilung|sigma=kein brauchbarer Peilfehler|time=keine brauchbare Zeit|heading=kein brauchbarer Kurs|power=keine brauchbare Leistung|frequency=keine brauchbare Frequenz|snr=kein brauchbares SNR|attitude=keine brauchbare Lage|noise_psd=keine brauchbare Rauschdichte|kind_of_row=keine Zeilenart (7, 10 oder 11)}.",
  ],
  row_left_out: [
    "Zeile {line} von {file} ist ausgelassen: {why?columns=Sie hat zu wenige Spalten|not_open=Sie beendet eine Drehung, die nie begann|two_offsets=Die Spalten 20 und 21 nennen beide einen Antennenversatz|wide=Sie hat mehr Zahlen, als es Spalten gibt}.",
    "{why?two_offsets=Eine Kopfzeile ergänzen, die den richtigen nennt.|wide=Haben Zahlen ein Dezimalkomma, die Spalten mit Semikolons trennen; sonst jede Spalte in einer Kopfzeile nennen.|*=}",
  ],
  rotation_irregular: [
    "Die Drehung ab Zeile {line} von {file} {why?empty=enthält keinen brauchbaren Puls und ist ausgelassen|not_closed=wird nie beendet (keine Zeile 11); sie endet, wo die nächste beginnt, oder mit der Datei|offset_changes=wechselt ihren Antennenversatz; der häufigste wird verwendet}.",
  ],
  pulses_outside_rotations: ["Aus {file} ausgelassen: {pulses|Puls|Pulse} außerhalb jeder Drehung."],
  tag_not_heard: [
    "Die Kennung {tag} war in der Drehung ab Zeile {line} von {file} nicht zu hören.",
    "Eine ihrer Kennungen wählen: {heard}.",
  ],
  one_tag_only: ["{file} enthält Peilungen der Kennungen {tags}.", "Eine davon nennen."],
  remarks_not_listed: ["{remarks|weitere Anmerkung|weitere Anmerkungen} zu {file}: nicht einzeln aufgeführt."],
  other_tags_left_out: [
    "Aus der Drehung ab Zeile {line} von {file} wird die Kennung {tag} verwendet, ohne {pulses|Puls|Pulse} anderer Kennungen ({others}).",
    "Um eine andere Kennung zu verwenden, sie nennen.",
  ],
  decibels_assumed: [
    "Die Leistung in Spalte {column} von {file} ({least:2} bis {most:2}) wird als Dezibel genommen.",
    "Stimmt das, die Spalte power_db nennen.",
  ],
  frequencies_unread: [
    'In Spalte {column} von {file} ist keine Frequenz lesbar, wie "{cell}" in Zeile {line}.',
    "Jede als eine Zahl schreiben, die Einheit dahinter oder im Namen der Spalte.",
  ],
  places_apart: [
    "Die Drehung ab Zeile {line} von {file} entstand an Orten, die {apart_m} auseinanderliegen.",
    "Mehrere Drehungen in einer Spalte namens sweep nummerieren.",
  ],
  headings_in_radians: [
    "Die Winkel in Spalte {column} von {file} ({least:2} bis {most:2}) scheinen Radiant zu sein.",
    "Grad schreiben und die Spalte heading_deg oder bearing_deg nennen.",
  ],
  power_linear: [
    "Die Leistung in Spalte {column} von {file} ({least} bis {most}) ist {by?name=dem Namen|values=den Werten} nach linear.",
    "Dezibel schreiben und die Spalte power_db nennen.",
  ],
  nothing_usable: [
    "Die Datei {file} enthält {wanted?bearing=keine brauchbare Peilung|power=keine brauchbare Zeile mit Kurs und Leistung|pulse=keinen brauchbaren Puls}. {because}",
    "{wanted?bearing=Die Spalten lat, lon, bearing_deg und, wenn bekannt, sigma_deg nennen.|power=Die Spalten heading_deg und power_db nennen.|pulse=Prüfen, ob es die richtige Datei ist.}",
  ],
  place_not_stated: ["Die Datei {file} sagt nicht, wo aufgenommen wurde.", "Die Spalten lat und lon ergänzen oder den Ort daneben nennen."],

  sigmf_field_missing: ["Die Aufnahme {file} nennt {field} nicht.", FIELD_REMEDY],
  sigmf_field_unusable: ["In der Aufnahme {file} ist {field} nicht verwendbar: {value}.", FIELD_REMEDY],
  sigmf_file_missing: [
    "Der Aufnahme {file} fehlt ihre Datei {missing}.",
    "Eine Aufnahme sind zwei Dateien: .sigmf-meta sagt, wie abgetastet wurde, .sigmf-data enthält die Abtastwerte.",
  ],
  samples_unusable: [
    "Die Aufnahme {file} {why?collection=ist eine Sammlung von mehreren|real=enthält reelle Abtastwerte, kein komplexes IQ|none=enthält keinen Abtastwert|zero=ist stumm: Jeder Abtastwert ist null|too_short=ist zu kurz für einen Messwert}.",
    "{why?collection=Eine einzelne Aufnahme angeben|real=Komplexes IQ aufnehmen|none=Prüfen, ob ihre Datendatei vollständig ist|zero=Prüfen, ob der Empfänger lief|too_short=Ihre Abtastrate prüfen}.",
  ],
  samples_not_numbers: [
    "In der Aufnahme {file} {samples?1=ist|*=sind} {samples|Abtastwert keine Zahl|Abtastwerte keine Zahlen}, der erste nach {first_s:2}.",
    "Sie herausschneiden oder core:datatype prüfen.",
  ],
  no_signal_found: [
    "Die Aufnahme {file} ist stumm: Nichts liegt {needed_db:0} über dem Rauschen.",
    "Ist der Sender schwächer, seine Frequenz nennen.",
  ],
  silent_at: [
    "Die Aufnahme {file} ist auf {frequency_hz} stumm: Der stärkste Messwert liegt {above_db} über dem Rauschen.",
    "Die Frequenz prüfen.",
  ],
  no_pulse_at: [
    "Auf {frequency_hz} war in der Aufnahme {file} kein Puls zu hören.",
    "Die Frequenz sowie Pulsbreite und Periode des Senders prüfen.",
  ],
  headings_apart: [
    "Die Kurse reichen von {from_s:1} bis {to_s:1} nach Beginn der Aufnahme {file}, die Abtastwerte nur bis {samples_s:1}.",
    "Die Zeiten und die Abtastrate ({sample_rate_hz}) prüfen.",
  ],
  headings_of_other_length: [
    "Die Kurse von {file} dauern {headings_s:1}, die Abtastwerte {samples_s:1}; verwendet wird, was sie gemeinsam haben.",
    "Die Abtastrate der Aufnahme ({sample_rate_hz}) prüfen.",
  ],
  first_channel_used: [
    "Die Aufnahme {file} hat {channels} Kanäle; der erste wird verwendet.",
    "Für einen anderen dessen Abtastwerte in eine eigene Aufnahme schreiben.",
  ],
  strongest_used: [
    "Verwendet wird das stärkste Signal der Aufnahme {file}, auf {frequency_hz}.",
    "Um ein anderes Signal zu verwenden, seine Frequenz nennen.",
  ],
  readings_without_heading: [
    "Aus der Aufnahme {file} ausgelassen, weil ihr Kurs nicht bekannt ist: {left_out} von {readings|Messwert|Messwerten}.",
  ],
  not_iq: [
    "Die Datei {file} enthält {given?headings=ihre eigenen Kurse und kein IQ, das eine Tabelle davon braucht|signal=Leistungen, kein IQ; darum werden darin weder Frequenz noch Pulse gesucht}.",
    "{given?headings=Die Tabelle der Kurse weglassen.|signal=}",
  ],
  recording_unusable: ["Die Aufnahme {file} ist nicht verwendbar. {because}", "{because!remedy}"],

  recording_too_long: ["Die Aufnahme enthält {sweeps} Drehungen.", "Höchstens {most} auf einmal einlesen."],
  asked_from_too_far: [
    "Von hier sind es {distance_m} bis zum Suchgebiet: zu weit für einen Rat, wo zu hören ist.",
    "Näher herangehen, oder sagen, von wo aus gesucht wird.",
  ],
  kraken_unreadable: [
    "Das ist keine Peilung eines KrakenSDR: {what}.",
    "Den Text seiner DOA_value.html senden, mit dem Ausgabeformat „Kraken App“ geschrieben.",
  ],
  heard_elsewhere: [
    "Die Peilung wurde auf {frequency_hz} gehört, dort wird nichts gesucht.",
    "Die Station auf eine Frequenz der Suche abstimmen.",
  ],
  place_too_far: ["Der Ort ist {distance_m} vom Suchgebiet entfernt.", "Den Ort prüfen, oder ihn der Suche melden, zu der er gehört."],
  bearing_time_impossible: [
    "Die Zeit der Peilung liegt in der Zukunft oder mehr als einen Tag zurück.",
    "Die Uhr des Geräts stellen, das sie gesendet hat.",
  ],
  which_emitter: ["Die Suche hat {emitters} Sender, und keiner ist genannt.", "Den Sender nennen."],
  taken_earlier: ["Sie wurde {age_s} vor ihrem Eintreffen genommen."],
  recording_too_far: [
    "Die Aufnahme entstand {distance_m} vom Gebiet der Mission entfernt.",
    "In eine Mission einlesen, deren Gebiet sie umgibt, oder den richtigen Ort nennen.",
  ],
  import_remark: [
    "{about?place_replaced=Der genannte Ort ersetzt den aus der Datei|altitude_unknown=0 m über dem Meer wird vermerkt, ohne Höhe ist die Datei|bearings_stand=Der genannte Ort oder die Antenne ändert keine Peilung in der Datei} {file}.",
  ],
  other_frequency: ["Die Datei {file} wurde auf {recorded_hz} aufgenommen; die Mission sucht {wanted_hz}."],
  half_given: [
    "{pair?place=Ein Ort braucht Breite und Länge|pulses=Ein pulsender Sender braucht Pulsbreite und Periode}.",
    "Beide nennen oder keines von beiden.",
  ],
  too_many_files: ["{files|Datei ist|Dateien sind} mehr als eine Aufnahme.", "Eine Datei hochladen oder Meta, Daten und Kurse."],
  two_recordings: ["Die Dateien {first} und {second} sind zwei Aufnahmen.", "Sie nacheinander hochladen."],
} satisfies Partial<ReasonTable>;
