// German: what happens in a mission and how it ends.
import type { ReasonTable } from "../reasons";

const LOOK = "Nach dem Fluggerät sehen und fortsetzen oder die Rückkehr befehlen.";

export const flight = {
  ordered: [
    "{order?start=Gestartet|resume=Fortgesetzt|hold=Angehalten|return=Rückkehr befohlen|land=Landung befohlen|abort=Abgebrochen|override=Ort gewählt|accept=Ort angenommen|veto=Ort abgelehnt|automatic=Automatisches Annehmen scharf geschaltet|exclude=Peilung weggelassen} durch {by}.",
  ],
  proceeds: [
    "{after?climb=Auf Höhe|plan=Der nächste Ort ist gewählt|flight=Der Ort ist erreicht|bearing=Die Peilung ist genommen|belief=Die Karte der Wahrscheinlichkeit ist erneuert|way_home=Über dem Startplatz|area=Das Suchgebiet ist geändert}.",
  ],
  no_console: ["{stage?hold=Keine Konsole ist verbunden|return=Keine Konsole kam zurück}.", "Eine Konsole verbinden und fortsetzen."],
  vehicle_link_lost: [
    "Die Funkstrecke zum Fluggerät ist weg.",
    "Solange handelt sein eigener Ausfallschutz. Die Funkstrecke wiederherstellen.",
  ],
  place_unknown: [
    "Das Fluggerät hat kein GPS mehr: Es weiß nicht, wo es ist.",
    "Bereit sein, von Hand zu fliegen: Der Autopilot landet bald, wo er ist.",
  ],
  battery_runs_low: [
    "Der Akku hat nur noch {charge_percent}.",
    "Rückkehr oder Landung befehlen: Ohne Mission rechnet niemand aus, was der Heimweg kostet.",
  ],
  payload_link_lost: ["Die Verbindung zum Begleitrechner ist weg.", "Seinen Strom und sein Netz prüfen."],
  back_after_restart: ["Der Server ist neu gestartet.", "Nach dem Fluggerät sehen, dann fortsetzen."],
  server_ends: ["Der Server wird beendet.", "Ihn wieder starten, nach dem Fluggerät sehen, dann fortsetzen."],
  pilot_flies: [
    "{perhaps_failsafe?true=Der Pilot oder der Ausfallschutz des Autopiloten|false=Der Pilot} steuert{mode?=, mit den Steuerknüppeln übernommen|*=: Das Fluggerät ist in }{mode}.",
    "Fortsetzen, wenn der Pilot die Steuerung zurückgegeben hat.",
  ],
  failsafe_flies: [
    "Der Autopilot kehrt von selbst heim oder landet: {because?silence=Er hatte von hier nichts gehört|link_lost=Die Funkstrecke war weg|server_away=Der Server war weg|ordered_before=Wie früher befohlen|battery=Akku schwach|transmitter=Handsender verloren|position=Position verloren|fence=Zaun verlassen|other=Ausfallschutz}.",
    "Fortsetzen, um weiterzusuchen, oder es landen lassen.",
  ],
  failsafe_stopped: [
    "Der eigene Heimweg des Autopiloten endete in {mode}, vielleicht durch einen früheren Befehl.",
    "Nach dem Fluggerät sehen, dann halten oder fortsetzen.",
  ],
  landed: [
    "Das Fluggerät ist gelandet{during?hold=, während die Mission angehalten war|automatic=, obwohl nichts es befohlen hat|manual=, während der Pilot oder sein eigener Ausfallschutz steuerte|localized=, und der Sender ist gefunden}.",
    "{during?manual=|localized=|*=Fortsetzen, um wieder abzuheben; abbrechen, um die Mission zu beenden.}",
  ],
  other_antenna: [
    "Der Server ist mit einem anderen Antennendiagramm neu gestartet ({given}); diese Mission behält ihres ({flown}).",
    "Wurde die Antenne selbst gewechselt: landen und eine neue Mission beginnen.",
  ],
  step_broke: [
    "{step?take_off=Das Abheben|fly=Der Flug|measure=Das Messen|plan=Das Planen|belief=Das Erneuern der Karte der Wahrscheinlichkeit|hold=Das Halten|return=Die Rückkehr|land=Die Landung} ist in Crossfix gescheitert.",
    LOOK,
  ],
  watch_broke: [
    "{watch?vehicle=Das Beobachten des Fluggeräts|changes=Das Hören auf das Fluggerät|track=Das Aufzeichnen des Wegs} ist in Crossfix gescheitert.",
    LOOK,
  ],
  place_unsure: [
    "Der Ort von Peilung {place_number} ist um {drift_m} unsicher; sie zählt weniger.",
    "Die gemeldete Position ist gesprungen, oder der Wind hat das Fluggerät versetzt: GPS und Wind prüfen.",
  ],
  not_stored: [
    "Nicht alles von dieser Mission kann gespeichert werden: {detail}.",
    "Es bleibt neben der Warteschlange des Journals liegen; der Flug geht weiter.",
  ],

  belief_broke: [
    "Wo {emitter_id} sein kann, ließ sich in Crossfix nicht neu berechnen: Kein nächster Ort wird geplant.",
    "Die letzte Peilung weglassen, oder die Rückkehr anordnen.",
  ],
  headings_askew: [
    "Alle Peilungen scheinen um denselben Winkel falsch zu sein, etwa {offset_deg} ± {std_error_deg}: Der gefundene Ort kann falsch sein.",
    "Kompass und Befestigung der Antenne prüfen; ein einzelner falscher Ort kann ebenso aussehen.",
  ],
  bearings_corrected: [
    "Alle Peilungen sind um etwa {bias_deg} ± {std_error_deg} verdreht; bei der Ortung ist das berücksichtigt.",
    "Kompass und Befestigung der Antenne vor dem nächsten Flug prüfen.",
  ],
  localized: ["Gefunden: Der erwartete Fehler ist nicht größer als das Ziel."],
  localized_against: [
    "Gefunden: Der erwartete Fehler ist nicht größer als das Ziel; {against} von {bearings|Peilung|Peilungen} {against?1=spricht|*=sprechen} dagegen.",
  ],
  sweep_incomplete: [
    "Von dieser Drehung sind diese Werte unbekannt: {unknown?bearing=Peilung|sigma=Peilfehler|quality=Güte|altitude=Höhe|drift=Drift}.",
    "Die Drehung wiederholen.",
  ],
  unheard_for_long: [
    "An den letzten {places|Ort|Orten} nicht gehört; die anderen kommen zuerst, bis er gehört wird.",
    "Die Reihenfolge erneut setzen, um ihn trotzdem zuerst zu suchen.",
  ],
  unclear_for_long: [
    "Seine Peilungen widersprechen sich seit {places|Ort|Orten}; die anderen kommen zuerst, bis sie zusammenpassen.",
    "Die Peilungen ansehen und eine falsche weglassen, oder die Reihenfolge erneut setzen.",
  ],
  first_for_long: [
    "{places|Ort wurde|Orte wurden} zuerst für ihn gewählt, und er ist nicht gefunden; nun kommen die anderen zuerst.",
    "Die Reihenfolge erneut setzen, um ihn trotzdem zuerst zu suchen.",
  ],
  frequency_shared: [
    "Zwei Sender senden auf {frequency_hz}, und nicht beide mit Pulsen: Kein Empfänger kann sie unterscheiden.",
    "Einen nach dem anderen suchen; Tiersender auf einer Frequenz unterscheidet ihre Periode.",
  ],
  frequencies_too_near: [
    "Sender auf {first_hz} und {second_hz} liegen so nah beieinander, dass der Empfänger jeden auf beiden Kanälen hört.",
    "Ab {needed_hz} Abstand sind sie zu unterscheiden. Tiersendern, die näher beieinander liegen, dieselbe Frequenz und ihre " +
      "Perioden geben, andere Sender einen nach dem anderen suchen.",
  ],
  too_many_rhythms: [
    "Mehr als {most} Tiersender senden auf {frequency_hz}: Zu viele ihrer Pulse fallen zusammen.",
    "Höchstens {most} zugleich suchen.",
  ],
  rhythms_too_alike: [
    "Auf {frequency_hz} sendet einer alle {first_s:3} und ein anderer alle {second_s:3}: Ihre Rhythmen sind zu ähnlich.",
    "Sender, die so schwanken, sind ab {needed_s:3} Unterschied der Perioden zu unterscheiden. Einen nach dem anderen suchen " +
      "oder eine kleinere Schwankung angeben, wenn ihre kleiner ist.",
  ],
  quality_too_low: ["Die Güte {quality:2} liegt unter {wanted:2}.", "Die Drehung wiederholen."],

  told_before: ["{text}", "{remedy}"],
  no_usable_bearing: ["{again?true=Die Drehung wird wiederholt|false=Hier keine brauchbare Peilung}: {because}", "{because!remedy}"],
  not_localized: ["Nicht gefunden. {because} {not_yet}"],
  places_used_up: ["{places|Ort ist|Orte sind} verbraucht, so viele, wie die Mission erlaubt."],
  no_longer_localized: ["Nicht mehr gefunden, seit eine Peilung weggelassen wurde. {not_yet}"],
  receiver_trouble: ["Empfänger: {because}", "{because!remedy}"],
  interrupted: [
    "Unterbrochen: {because?later_mission=In der Luft ist eine später gestartete Mission|unreadable=Sie ist nicht mehr lesbar}.",
  ],
  not_done: [
    "{order?hold=Das Halten|return=Die Rückkehr|land=Die Landung|abort=Der Abbruch} ist nicht geschehen: {because} {next_way?hold=Das Halten|return=Die Rückkehr|land=Das Landen an Ort und Stelle} wird in {next_in_s} versucht.",
    "Ein anderer Befehl tritt an seine Stelle. Der Pilot kann jederzeit übernehmen.",
  ],
  instead: [
    "{order?hold=Das Halten|return=Die Rückkehr|land=Die Landung|abort=Der Abbruch} war nicht möglich, darum {way?hold=hält das Fluggerät|return=kehrt das Fluggerät zurück|land=landet das Fluggerät, wo es ist}. {because}",
    "Nach dem Fluggerät sehen. Ein anderer Befehl tritt an seine Stelle.",
  ],
  autopilot_flies_home: [
    "Der Autopilot fliegt auf seinem eigenen Weg zurück, der keine Flugverbotsgebiete kennt: {because}",
    "Hinsehen; Anhalten stoppt ihn.",
  ],
  ordered_again_later: ["{because}", "Es wird noch einmal befohlen, wenn das Fluggerät wieder zu hören ist."],
} satisfies Partial<ReasonTable>;
