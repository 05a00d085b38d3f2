// German: what the vehicle did not do and what it reports.
import type { ReasonTable } from "../reasons";

const ACTION = "take_off=Das Abheben|flight=Der Flug|turn=Die Drehung|hold=Das Halten|return=Die Rückkehr|landing=Die Landung";
const BY_ACTION = "take_off=das Abheben|flight=den Flug|turn=die Drehung|hold=das Halten|return=die Rückkehr|landing=die Landung";
const COMMAND =
  "take_off_mode=den Modus zum Abheben|arming=das Scharfschalten|take_off=das Abheben|steering_mode=den Modus zum Steuern" +
  "|place=den nächsten Ort|speed=die Geschwindigkeit" +
  "|spot=das Halten auf der Stelle|turn=die Drehung|hold=das Halten|return=die Rückkehr|landing=die Landung";

export const vehicle = {
  vehicle_link_not_opened: [
    "Die Funkstrecke {url} zum Fluggerät lässt sich nicht öffnen: {problem}.",
    "Prüfen, ob das Gerät da ist. Vielleicht benutzt eine andere Bodenstation den Anschluss.",
  ],
  no_autopilot_answers: [
    "Auf {url} antwortet binnen {waited_s} kein Autopilot.",
    "Ihn einschalten und prüfen, ob er an diese Adresse sendet.",
  ],
  heartbeat_stopped: [
    "Auf {url} antwortete ein Autopilot, aber sein Lebenszeichen ist ausgeblieben.",
    "Seinen Strom und die Funkstrecke prüfen.",
  ],
  unknown_autopilot: [
    "Der Autopilot auf {url} ist weder PX4 noch ArduPilot (MAV_AUTOPILOT {number}).",
    "Ein Fluggerät mit einem der beiden verbinden.",
  ],
  vehicle_not_connected: ["Auf {url} ist kein Fluggerät verbunden.", "Es einschalten und seine Funkstrecke und Adresse prüfen."],
  vehicle_silent: [`{manoeuvre?${ACTION}} wurde aufgegeben: Seit {silent_s} ist vom Fluggerät nichts zu hören.`, "Die Funkstrecke prüfen."],
  position_lost: ["Das Fluggerät kennt seine Position nicht.", "Auf GPS warten."],
  sticks_moved: [
    `{manoeuvre?${ACTION}} ist nicht möglich: Der Pilot hat mit den Steuerknüppeln übernommen.`,
    "Fortsetzen, wenn der Pilot die Steuerung zurückgegeben hat.",
  ],
  mode_not_commanded: [
    `{manoeuvre?${ACTION}} ist nicht möglich: {who?failsafe=Der Ausfallschutz des Autopiloten|*=Jemand anders} hat {mode} gewählt, was Crossfix nicht befohlen hat.`,
    "{who?pilot=Fortsetzen, wenn der Pilot die Steuerung zurückgegeben hat|failsafe=Halten oder fortsetzen, um ihm das Fluggerät abzunehmen|nobody=Fortsetzen oder neu losfliegen}.",
  ],
  manoeuvre_replaced: [`{manoeuvre?${ACTION}} wurde ersetzt durch {by?${BY_ACTION}}.`],
  autopilot_refused: [
    `Der Autopilot lehnte {command?${COMMAND}} ab ({result?temporarily_rejected=vorübergehend|in_progress=noch in Arbeit|denied=verweigert|unsupported=nicht unterstützt|failed=gescheitert|cancelled=abgebrochen|*=ohne Angabe von Gründen}).{said?=|*= Er sagt: „}{said}{said?=|*=“.}`,
    "Die Meldungen des Autopiloten lesen.",
  ],
  place_not_taken: ["Der Autopilot fliegt nicht an diesen Ort.{said?=|*= Er sagt: „}{said}{said?=|*=“.}", "Den Zaun ansehen, den er hat."],
  autopilot_said: ["Der Autopilot sagt: „{text}“."],
  autopilot_repeats: ["Der Autopilot sagt wieder: „{text}“ ({times|Mal|Mal})."],
  autopilot_said_more: [
    "Der Autopilot sagte {texts|weitere Sache|weitere Sachen}, mehr als sich zeigen lässt.",
    "Im Protokoll des Servers nachlesen.",
  ],
  command_unanswered: [`Der Autopilot antwortete nicht auf {command?${COMMAND}} ({attempts|Mal|Mal} gesendet).`, "Die Funkstrecke prüfen."],
  mode_not_shown: [
    `Der Autopilot bestätigte {command?${COMMAND}} ({attempts|Mal|Mal}), aber sein Modus zeigte es nie.`,
    "Die Meldungen des Autopiloten lesen.",
  ],
  mode_left: [`Das Fluggerät hat den Modus verlassen, in dem es folgt: {command?${COMMAND}}.`, "Die Meldungen des Autopiloten lesen."],
  not_in_the_air: ["Das Fluggerät ist nicht in der Luft.", "Zuerst abheben."],
  stands_disarmed: [
    "Das Fluggerät steht am Boden und ist nicht scharf: {manoeuvre?return=Es gibt keinen Heimweg|landing=Es gibt nichts zu landen}.",
  ],
  take_off_ignored: ["Der Autopilot bestätigte das Abheben, aber das Fluggerät blieb am Boden.", "Die Meldungen des Autopiloten lesen."],
  no_take_off: ["Kein Abheben binnen {waited_s}. {because}", "{because!remedy}"],
  climb_too_low: ["Das Fluggerät stieg nur auf {reached_m:1}, nicht auf {wanted_m:1}.", "Nach einer Höhengrenze des Autopiloten sehen."],
  no_progress: ["Seit {waited_s} kein Fortschritt, noch {distance_m} zu fliegen.", "Den Wind prüfen."],
  not_arrived: [
    "Das Fluggerät kam nicht an: Es ist noch {distance_m:1} entfernt und {climb_m:1} zu hoch oder zu tief.",
    "Den Wind und die Meldungen des Autopiloten prüfen.",
  ],
  turn_stopped: ["Die Drehung endete nach {turned_deg}."],
  turn_not_made: [
    "Das Fluggerät bestätigte die Drehung, machte sie aber nicht: {turned_deg} gesehen, {ways|Weg|Wege} versucht.",
    "Den Wind und die Meldungen des Autopiloten prüfen.",
  ],
  hold_ignored: ["Der Autopilot bestätigte das Halten, aber das Fluggerät schwebt nicht auf der Stelle."],
  does_not_hold: ["{because}", "Der Pilot sollte übernehmen."],
  parameter_not_set: ["Der Autopilot nahm {parameter} = {wanted} nicht an.", "Den Wert mit seiner eigenen Bodenstation setzen."],

  vehicle_connected: ["Verbunden mit {autopilot?px4=PX4|ardupilot=ArduPilot} auf {url}."],
  vehicle_unheard: [
    "Die Funkstrecke zum Fluggerät ist weg.",
    "Funk, Kabel und Adresse des Fluggeräts prüfen; solange handelt der Ausfallschutz des Autopiloten.",
  ],
  vehicle_heard_again: ["Die Funkstrecke zum Fluggerät ist nach {outage_s:1} wieder da."],
  autopilot_restarted: ["Der Autopilot ist neu gestartet."],
  mode_changed: ["Das Fluggerät ist in {mode}."],
  position_jumped: ["Die GPS-Position ist um {jumped_m} gesprungen."],
  taken_over: ["{who?pilot=Der Pilot|failsafe=Der Ausfallschutz des Autopiloten} hat in {mode} übernommen."],
  taken_over_by_sticks: ["Der Pilot hat mit den Steuerknüppeln übernommen."],
  clock_rate_odd: [
    "Die Uhr des Autopiloten geht {rate:2}-mal so schnell wie unsere: Seine Richtungen lassen sich nicht datieren.",
    "Den Autopiloten neu starten. Eine Simulation braucht mehr Rechenzeit.",
  ],
  switch_undone: [
    "Ein Befehl, der schon unterwegs war, hat den Schalter des Piloten überstimmt: Das Fluggerät ist in {mode}. Es wird nichts mehr gesendet.",
    "Der Pilot wählt den Modus noch einmal.",
  ],
  still_moving: ["Das Fluggerät hält, bewegt sich aber noch mit {speed_m_s:1}.", "Nach dem Wind sehen."],
  operator_in_control: ["Der Bediener hat die Steuerung übernommen."],
  parameter_set: ["{parameter} wurde von {before} auf {after} gesetzt."],
  tried_again: ["{because} Es folgt Versuch {attempt}."],
} satisfies Partial<ReasonTable>;
