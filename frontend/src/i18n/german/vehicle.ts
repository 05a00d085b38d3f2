// German: what the vehicle did not do and what it reports.
import type { ReasonTable } from "../reasons";

const ACTION = "take_off=Das Abheben|flight=Der Flug|turn=Die Drehung|hold=Das Halten|return=Die Rückkehr|landing=Die Landung";
const BY_ACTION = "take_off=das Abheben|flight=den Flug|turn=die Drehung|hold=das Halten|return=die Rückkehr|landing=die Landung";
const COMMAND =
  "take_off_mode=den Modus zum Abheben|arming=das Scharfschalten|take_off=das Abheben|steering_mode=den Modus zum Steuern" +
  "|place=den nächsten Ort|speed=die Geschwindigkeit" +
  "|spot=das Halten auf der Stelle|turn=die Drehung|hold=das Halten|return=die Rückkehr|landing=die Landung";

export const vehicle = {
  vehicle_link_not_opened: {
    text: "Die Funkstrecke {url} zum Fluggerät lässt sich nicht öffnen: {problem}.",
    remedy: "Prüfen, ob das Gerät da ist. Vielleicht benutzt eine andere Bodenstation den Anschluss.",
  },
  no_autopilot_answers: {
    text: "Auf {url} antwortet binnen {waited_s} kein Autopilot.",
    remedy: "Ihn einschalten und prüfen, ob er an diese Adresse sendet.",
  },
  heartbeat_stopped: {
    text: "Auf {url} antwortete ein Autopilot, aber sein Lebenszeichen ist ausgeblieben.",
    remedy: "Seinen Strom und die Funkstrecke prüfen.",
  },
  unknown_autopilot: {
    text: "Der Autopilot auf {url} ist weder PX4 noch ArduPilot (MAV_AUTOPILOT {number}).",
    remedy: "Ein Fluggerät mit einem der beiden verbinden.",
  },
  vehicle_not_connected: {
    text: "Auf {url} ist kein Fluggerät verbunden.",
    remedy: "Es einschalten und seine Funkstrecke und Adresse prüfen.",
  },
  vehicle_silent: {
    text: `{manoeuvre?${ACTION}} wurde aufgegeben: Seit {silent_s} ist vom Fluggerät nichts zu hören.`,
    remedy: "Die Funkstrecke prüfen.",
  },
  position_lost: { text: "Das Fluggerät kennt seine Position nicht.", remedy: "Auf GPS warten." },
  sticks_moved: {
    text: `{manoeuvre?${ACTION}} ist nicht möglich: Der Pilot hat mit den Steuerknüppeln übernommen.`,
    remedy: "Fortsetzen, wenn der Pilot die Steuerung zurückgegeben hat.",
  },
  mode_not_commanded: {
    text: `{manoeuvre?${ACTION}} ist nicht möglich: {who?failsafe=Der Ausfallschutz des Autopiloten|*=Jemand anders} hat {mode} gewählt, was Crossfix nicht befohlen hat.`,
    remedy:
      "{who?pilot=Fortsetzen, wenn der Pilot die Steuerung zurückgegeben hat|failsafe=Halten oder fortsetzen, um ihm das Fluggerät abzunehmen|nobody=Fortsetzen oder neu losfliegen}.",
  },
  manoeuvre_replaced: {
    text: `{manoeuvre?${ACTION}} wurde ersetzt durch {by?${BY_ACTION}}.`,
    remedy: "",
  },
  autopilot_refused: {
    text: `Der Autopilot lehnte {command?${COMMAND}} ab ({result?temporarily_rejected=vorübergehend|in_progress=noch in Arbeit|denied=verweigert|unsupported=nicht unterstützt|failed=gescheitert|cancelled=abgebrochen|*=ohne Angabe von Gründen}).{said?=|*= Er sagt: „}{said}{said?=|*=“.}`,
    remedy: "Die Meldungen des Autopiloten lesen.",
  },
  place_not_taken: {
    text: "Der Autopilot fliegt nicht an diesen Ort.{said?=|*= Er sagt: „}{said}{said?=|*=“.}",
    remedy: "Den Zaun ansehen, den er hat.",
  },
  autopilot_said: { text: "Der Autopilot sagt: „{text}“.", remedy: "" },
  autopilot_repeats: { text: "Der Autopilot sagt wieder: „{text}“ ({times|Mal|Mal}).", remedy: "" },
  autopilot_said_more: {
    text: "Der Autopilot sagte {texts|weitere Sache|weitere Sachen}, mehr als sich zeigen lässt.",
    remedy: "Im Protokoll des Servers nachlesen.",
  },
  command_unanswered: {
    text: `Der Autopilot antwortete nicht auf {command?${COMMAND}} ({attempts|Mal|Mal} gesendet).`,
    remedy: "Die Funkstrecke prüfen.",
  },
  mode_not_shown: {
    text: `Der Autopilot bestätigte {command?${COMMAND}} ({attempts|Mal|Mal}), aber sein Modus zeigte es nie.`,
    remedy: "Die Meldungen des Autopiloten lesen.",
  },
  mode_left: {
    text: `Das Fluggerät hat den Modus verlassen, in dem es folgt: {command?${COMMAND}}.`,
    remedy: "Die Meldungen des Autopiloten lesen.",
  },
  not_in_the_air: { text: "Das Fluggerät ist nicht in der Luft.", remedy: "Zuerst abheben." },
  stands_disarmed: {
    text: "Das Fluggerät steht am Boden und ist nicht scharf: {manoeuvre?return=Es gibt keinen Heimweg|landing=Es gibt nichts zu landen}.",
    remedy: "",
  },
  take_off_ignored: {
    text: "Der Autopilot bestätigte das Abheben, aber das Fluggerät blieb am Boden.",
    remedy: "Die Meldungen des Autopiloten lesen.",
  },
  no_take_off: { text: "Kein Abheben binnen {waited_s}. {because}", remedy: "{because!remedy}" },
  climb_too_low: {
    text: "Das Fluggerät stieg nur auf {reached_m:1}, nicht auf {wanted_m:1}.",
    remedy: "Nach einer Höhengrenze des Autopiloten sehen.",
  },
  no_progress: { text: "Seit {waited_s} kein Fortschritt, noch {distance_m} zu fliegen.", remedy: "Den Wind prüfen." },
  not_arrived: {
    text: "Das Fluggerät kam nicht an: Es ist noch {distance_m:1} entfernt und {climb_m:1} zu hoch oder zu tief.",
    remedy: "Den Wind und die Meldungen des Autopiloten prüfen.",
  },
  turn_stopped: { text: "Die Drehung endete nach {turned_deg}.", remedy: "" },
  turn_not_made: {
    text: "Das Fluggerät bestätigte die Drehung, machte sie aber nicht: {turned_deg} gesehen, {ways|Weg|Wege} versucht.",
    remedy: "Den Wind und die Meldungen des Autopiloten prüfen.",
  },
  hold_ignored: { text: "Der Autopilot bestätigte das Halten, aber das Fluggerät schwebt nicht auf der Stelle.", remedy: "" },
  does_not_hold: { text: "{because}", remedy: "Der Pilot sollte übernehmen." },
  parameter_not_set: {
    text: "Der Autopilot nahm {parameter} = {wanted} nicht an.",
    remedy: "Den Wert mit seiner eigenen Bodenstation setzen.",
  },

  vehicle_connected: { text: "Verbunden mit {autopilot?px4=PX4|ardupilot=ArduPilot} auf {url}.", remedy: "" },
  vehicle_unheard: {
    text: "Die Funkstrecke zum Fluggerät ist weg.",
    remedy: "Funk, Kabel und Adresse des Fluggeräts prüfen; solange handelt der Ausfallschutz des Autopiloten.",
  },
  vehicle_heard_again: { text: "Die Funkstrecke zum Fluggerät ist nach {outage_s:1} wieder da.", remedy: "" },
  autopilot_restarted: { text: "Der Autopilot ist neu gestartet.", remedy: "" },
  mode_changed: { text: "Das Fluggerät ist in {mode}.", remedy: "" },
  position_jumped: { text: "Die GPS-Position ist um {jumped_m} gesprungen.", remedy: "" },
  taken_over: {
    text: "{who?pilot=Der Pilot|failsafe=Der Ausfallschutz des Autopiloten} hat in {mode} übernommen.",
    remedy: "",
  },
  taken_over_by_sticks: { text: "Der Pilot hat mit den Steuerknüppeln übernommen.", remedy: "" },
  clock_rate_odd: {
    text: "Die Uhr des Autopiloten geht {rate:2}-mal so schnell wie unsere: Seine Richtungen lassen sich nicht datieren.",
    remedy: "Den Autopiloten neu starten. Eine Simulation braucht mehr Rechenzeit.",
  },
  switch_undone: {
    text: "Ein Befehl, der schon unterwegs war, hat den Schalter des Piloten überstimmt: Das Fluggerät ist in {mode}. Es wird nichts mehr gesendet.",
    remedy: "Der Pilot wählt den Modus noch einmal.",
  },
  still_moving: {
    text: "Das Fluggerät hält, bewegt sich aber noch mit {speed_m_s:1}.",
    remedy: "Nach dem Wind sehen.",
  },
  operator_in_control: { text: "Der Bediener hat die Steuerung übernommen.", remedy: "" },
  parameter_set: { text: "{parameter} wurde von {before} auf {after} gesetzt.", remedy: "" },
  tried_again: { text: "{because} Es folgt Versuch {attempt}.", remedy: "" },
} satisfies Partial<ReasonTable>;
