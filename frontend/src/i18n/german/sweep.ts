// German: why a sweep gives no bearing; antenna and pattern.
import type { ReasonTable } from "../reasons";

export const sweep = {
  no_pulse_heard: ["In keiner Richtung war ein Puls des Senders zu hören.", "Ihn einschalten oder näher bei ihm messen."],
  pulses_not_given: [
    "Auf dieser Frequenz senden mehrere: {given} Pulse sind zugeordnet; {overlapping} von zweien zugleich, {unclear}, die von " +
      "mehr als einem sein könnten, und {strangers}, die zu keinem passen, zählen für keinen.",
  ],
  rhythm_not_heard: [
    "Im Rhythmus dieses Senders war kein Puls zu hören; auf seiner Frequenz waren es {given} Pulse anderer und {left}, die für " +
      "keinen zählen.",
    "Näher bei ihm messen; seine Periode und deren Schwankung in der Mission prüfen.",
  ],
  readings_left_out: [
    "{readings|Messwert|Messwerte} weggelassen: {why?heading_unknown=keine Richtung nahe genug in der Zeit" +
      "|place_unknown=der Ort des Fluggeräts war nicht sicher|overdriven=der Empfänger war übersteuert" +
      "|at_noise=kaum über dem Rauschen|beside_a_turn=neben einem Ort, an dem es ohnehin gedreht und gehört hat" +
      "|pointed_one_way=die Antenne zeigte in eine Richtung, die Leistung sagt dann keine Peilung" +
      "|too_many=andere Abschnitte des Wegs wurden weiter gedreht}.",
  ],
  nose_swung: [
    "Die Nase pendelte um {amplitude_deg} nach jeder Seite, {swung|Mal|Mal} bis ans Ende, mit {rate_deg_s} und höchstens {lag_deg} zurück" +
      "{end?near_place=, bis der Ort nahe war|not_ours=, bis ein anderer Befehl kam oder jemand anderes flog" +
      "|lags=. Dann folgte sie nicht und wurde in Ruhe gelassen|refused=. Dann lehnte der Autopilot ab, und sie wurde in Ruhe gelassen}.",
  ],
  no_heading_heard: ["Das Fluggerät meldete während der Drehung keine Richtung.", "Seine Telemetrie und die Rate von ATTITUDE prüfen."],
  headings_not_numbers: [
    "Die Richtungen des Fluggeräts sind keine Zahlen.",
    "Seinen Kompass kalibrieren oder den Autopiloten neu starten.",
  ],
  no_position_heard: ["Das Fluggerät meldete während der Drehung keine Position.", "Auf GPS warten."],
  clocks_apart: [
    "Messwerte und Richtungen liegen {apart_s:1} auseinander.",
    "Die Uhren von Empfänger und Fluggerät nach GPS oder NTP stellen.",
  ],
  headings_interrupted: [
    "Wo etwas zu hören war, meldete das Fluggerät mehr als {longest_s:1} lang keine Richtung.",
    "Nach Lücken in der Telemetrie suchen.",
  ],
  power_not_numbers: ["Kein Leistungswert der Drehung ist eine glaubhafte Zahl.", "Den Empfänger neu starten."],
  overdriven: [
    "Der Empfänger war übersteuert: {clipped} von {samples} Messwerten sind abgeschnitten.",
    "Die Verstärkung senken oder weiter weg messen.",
  ],
  too_few_directions: [
    "Nur in {heard|Richtung|Richtungen} war etwas zu hören; rundum sind mindestens {needed} nötig.",
    "Langsamer drehen oder die Abtastrate des Empfängers erhöhen.",
  ],
  turn_incomplete: [
    "Nur über {heard_deg} der Drehung war etwas zu hören.",
    "Einmal ganz herum drehen, während der Empfänger hört, oder näher am Sender.",
  ],
  constant_power: [
    "Der Empfänger zeigt in jeder Richtung dieselbe Leistung: einen festen Wert, kein Signal.",
    "Seinen Antenneneingang und seine Verstärkung prüfen.",
  ],
  nothing_above_noise: ["Nichts gehört: Keine Richtung liegt {needed_db:0} über dem Rauschen.", "Näher beim Sender messen."],
  no_direction: ["In der Drehung steckt keine Richtung: Die Leistung ändert sich kaum mit ihr."],
  unlike_antenna: [
    "Die Drehung sieht nicht nach der Antenne aus (Ähnlichkeit {quality:2}, nötig sind {needed:2}): Reflexionen, Störung oder kein Signal.",
  ],
  direction_in_gap: ["Die stärkste Richtung liegt in einer Lücke von {gap_deg}, in der der Empfänger nicht gehört hat."],
  pattern_borrowed: [
    "Die Peilung beruht auf dem Diagramm einer anderen Antenne ({name}) und ist deshalb unsicherer.",
    "Das Diagramm der Antenne messen, die mitfliegt: crossfix calibrate.",
  ],
  likely_other_antenna: [
    "Die Drehung sieht nach einer anderen Antenne als {name} aus: Nur die Hauptkeule wurde verwendet.",
    "Prüfen, welche Antenne montiert ist, und ihr Diagramm messen: crossfix calibrate.",
  ],
  other_direction_likely: ["Die Drehung passt fast ebenso gut zu {other_bearing_deg}.", "Auch von einem anderen Ort hören."],
  not_the_measured_antenna: [
    "Das ist nicht die Antenne, die gemessen wurde: {sweeps} Drehungen weichen auf die gleiche Weise um {repeats_db:1} vom Diagramm {name} ab.",
    "Prüfen, welche Antenne montiert ist und wie, oder das vorgeschlagene Diagramm übernehmen.",
  ],

  antenna_agrees: ["Gemessen {measured_deg}, wahr {true_deg}, Güte {quality:2}."],
  emitter_too_near: ["Der Sender ist nur {distance_m} entfernt.", "Mindestens {least_m} von ihm entfernt drehen."],
  antenna_dead: [
    "Die Leistung ändert sich während der Drehung nur um {heard_db}, das Diagramm um {pattern_db:0}: Die Antenne ist wohl tot oder nicht angeschlossen.",
    "Prüfen, ob Kabel, Stecker und Element der Antenne heil sind und der Prüfsender an ist.",
  ],
  antenna_unlike_pattern: [
    "Die Drehung passt nicht zum Antennendiagramm. {because}",
    "Prüfen, ob dies die Antenne des gewählten Diagramms ist, ihr Element ganz ist und der Sender dieselbe Polarisation hat.",
  ],
  antenna_askew: [
    "Der Sender liegt bei {true_deg}, gemessen wurde er bei {measured_deg}.",
    "Den Versatz der Antenne auf {offset_deg} setzen oder die Antenne drehen; stimmt beides, den Kompass kalibrieren.",
  ],
  receiver_clock_off: [
    "Die Uhr des Empfängers weicht um {offset_s:2} von der des Fluggeräts ab.",
    "Beide nach GPS oder NTP stellen, dann noch einmal drehen.",
  ],
  too_few_samples: [
    "Die Drehungen enthalten nur {samples|Messwert|Messwerte}; ein Diagramm braucht mindestens {needed}.",
    "Langsamer drehen oder mehr Drehungen fliegen.",
  ],
  no_magnetic_model: [
    "Für das Jahr {year} gibt es kein Magnetfeldmodell.",
    "Das Paket pygeomag aktualisieren oder die Missweisung von Hand setzen.",
  ],

  not_a_pattern: [
    "Die Datei {file} ist kein Antennendiagramm: {why?json=Sie ist kein JSON|format=Sie nennt nicht das Format „crossfix antenna pattern“|relative_bearing_deg=relative_bearing_deg fehlt|gain=gain fehlt|unit=unit fehlt|rows=Sie hat keine Zeilen „angle_deg, gain“|numbers=Ein Winkel, ein Gewinn, der Versatz oder die Frequenz ist keine endliche Zahl|counts=Nicht zu jedem Winkel gehört ein Gewinn|positive=Ein linearer Gewinn ist nicht größer als null}.",
    "Eine Datei nehmen, die crossfix calibrate schrieb, oder eine Drehtisch-Tabelle angle_deg, gain_db mit der Endung .csv.",
  ],
  pattern_row_unusable: ["Zeile {line} von {file} ist nicht „angle_deg, gain“: {row}.", "Die Zeile berichtigen oder entfernen."],
  pattern_unit_unknown: ["Die Einheit „{unit}“ der Gewinne in {file} ist nicht bekannt.", "„dB“ oder „linear power“ schreiben."],
  too_few_points: ["Das Diagramm {name} hat nur {points|Punkt|Punkte}.", "Rundum mindestens {needed} messen."],
  angle_twice: ["Der Winkel {angle_deg:1} kommt im Diagramm {name} zweimal vor.", "Eine Zeile je Winkel behalten."],
  pattern_gap: ["Das Diagramm {name} hat nach {after_deg} eine Lücke von {gap_deg}.", "Ganz herum messen, mindestens alle {widest_deg}."],
  implausible_gains: [
    "Der Gewinn im Diagramm {name} schwankt rundum um {spread?small=weniger|large=mehr} als {limit_db:0}.",
    "Prüfen, ob das Element der Antenne ganz ist und die Einheit der Tabelle stimmt.",
  ],
  pattern_of_other_frequency: [
    "Das Diagramm {name} wurde bei {measured_hz:1} gemessen, nicht bei {wanted_hz:1}.",
    "Ein Diagramm nehmen, das bei der Frequenz des Senders gemessen wurde.",
  ],
} satisfies Partial<ReasonTable>;
