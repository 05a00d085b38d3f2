// German: receivers, channels and radios.
import type { ReasonTable } from "../reasons";

const DEVICE = "soapy:driver=NAME[,key=value], rtl_tcp://HOST[:PORT], sigmf:FILE oder recording:FILE";

export const receiver = {
  receiver_misnamed: [
    "Die Angabe „{device}“ für den Empfänger {fault?form=ist nicht zu verstehen|host=nennt keinen Rechner|port=nennt einen Port, der keine Zahl von 1 bis 65535 ist|driver=nennt keinen Treiber|server=nennt keinen Server}.",
    `So schreiben: {fault?form=${DEVICE}|host=rtl_tcp://HOST[:PORT]|port=rtl_tcp://HOST[:PORT]|driver=zum Beispiel driver=rtlsdr; eine Suche ohne Treiber würde das Netz abfragen|server=driver=remote,remote=tcp://HOST:PORT; eine Suche nach Servern würde das Netz abfragen}.`,
  ],
  receiver_not_open: ["Der Empfänger ist nicht geöffnet.", "Ihn zuerst mit seinen Kanälen öffnen."],
  receiver_silent: [
    "Der Empfänger hat seit {quiet_s} nichts geliefert.",
    "Kabel und Treiber prüfen, ebenso, ob ein anderes Programm ihn benutzt.",
  ],
  nothing_heard_in_turn: ["Der Empfänger lieferte während der Drehung nichts.", "Prüfen, ob er läuft und abgestimmt ist."],
  receiver_stream_ended: [
    "Der Datenstrom des Empfängers ist zu Ende.",
    "Nach dem Funkgerät sehen oder die Aufnahme noch einmal abspielen.",
  ],
  receiver_unplugged: ["Der Empfänger wurde abgezogen.", "Ihn wieder anstecken."],
  samples_lost: [
    "Der Empfänger verlor {lost_percent} seiner Abtastwerte.",
    "Prüfen, ob er noch verbunden ist; ist dieser Rechner zu langsam für ihn, die Abtastrate senken.",
  ],
  nonsensical_power: [
    "Der Empfänger liefert eine Leistung von {value} dB, die es nicht geben kann; solche Messwerte werden ausgelassen.",
    "Den Empfänger und seinen Treiber prüfen.",
  ],
  recorded_sweep_empty: ["Die aufgenommene Drehung enthält keinen Messwert.", "Eine andere Aufnahme angeben."],

  no_channel: ["Vom Empfänger wurde kein Kanal verlangt.", "Mindestens einen Sender mit seiner Frequenz nennen."],
  frequency_out_of_range: [
    "Der Empfänger lässt sich nicht auf {frequency_hz} abstimmen.",
    "Die Frequenz des Senders prüfen oder einen anderen Empfänger benutzen.",
  ],
  frequency_twice: [
    "{frequency_hz} wurde vom Empfänger zweimal verlangt; er könnte die beiden Sender nicht unterscheiden.",
    "Einen nach dem anderen suchen.",
  ],
  frequency_not_asked_for: ["Der Empfänger liefert Messwerte auf {frequency_hz}, die niemand verlangt hat.", "Den Empfänger neu starten."],
  carriers_only: [
    "Dieser Empfänger misst nur Träger, der Sender auf {frequency_hz} aber pulst.",
    "Einen Empfänger benutzen, der IQ liefert.",
  ],
  one_channel_only: [
    "Dieser Empfänger hört immer nur einen Sender; verlangt wurden {asked}.",
    "Einen nach dem anderen suchen oder einen Empfänger benutzen, der IQ liefert.",
  ],
  band_too_narrow: [
    "Mit einer Abtastrate von {sample_rate_hz} kann der Empfänger {refused_hz} nicht zugleich mit den anderen hören.",
    "Die Abtastrate auf {needed_hz} erhöhen oder in der Mission angeben, wie breit das Band des Empfängers ist: Dann hört er sie nacheinander.",
  ],
  outside_band: [
    "Eine Abtastrate von {sample_rate_hz} um {centre_hz} reicht nicht bis {refused_hz}.",
    "Näher daran abstimmen oder die Abtastrate erhöhen.",
  ],
  recorded_elsewhere: [
    "Die Aufnahme entstand auf {recorded_hz}, nicht auf {wanted_hz}.",
    "Die Frequenz des Senders wie in der Aufnahme nennen oder eine andere Aufnahme angeben.",
  ],
  sample_rate_too_low: ["Eine Abtastrate von {sample_rate_hz} ist zu niedrig.", "Die Abtastrate auf mindestens {needed_hz} erhöhen."],
  impossible_pulses: [
    "Einen Puls von {width_s:3} alle {period_s:3} kann es nicht geben.",
    "Eine Breite größer als null und kleiner als die Periode angeben.",
  ],

  soapy_missing: [
    "SoapySDR ist für dieses Python nicht installiert.",
    "Das Systempaket python3-soapysdr (und das Modul des Funkgeräts) installieren und SoapySDR.py in dieser Umgebung sichtbar machen (wie, sagt das Benutzerhandbuch) oder einen Empfänger mit rtl_tcp:// verwenden.",
  ],
  radio_failed: [
    "Das Funkgerät „{device}“ {stage?call=meldet einen Fehler|start=startet nicht|read=liefert nichts mehr} ({says}).",
    "Geräteangabe und Kabel prüfen.",
  ],
  no_receive_channel: ["Das Funkgerät „{device}“ hat keinen Empfangskanal.", "Ein Funkgerät benutzen, das empfangen kann."],
  tuned_elsewhere: ["Das Funkgerät „{device}“ stimmte auf {tuned_hz} statt auf {wanted_hz} ab.", "Prüfen, ob das in seinem Bereich liegt."],
  rtl_sdr_sample_rate: [
    "Ein RTL-SDR kann nicht mit {sample_rate_hz} abtasten.",
    "225001 bis 300000 oder 900001 bis 3200000 Abtastwerte in der Sekunde wählen.",
  ],
  rtl_tcp_unreachable: ["Der rtl_tcp-Server auf {address} ist nicht erreichbar ({detail}).", "Ihn dort starten."],
  rtl_tcp_busy: [
    "Der rtl_tcp-Server auf {address} {closed?true=hat die Verbindung geschlossen|false=antwortet nicht}.",
    "Prüfen, ob er läuft und kein anderes Programm damit verbunden ist.",
  ],
  not_rtl_tcp: ["Das Programm, das auf {address} antwortet, ist kein rtl_tcp-Server.", "Die Adresse berichtigen."],
  rtl_tcp_ended: [
    "{broken?true=Die Verbindung zum rtl_tcp-Server|false=Der Datenstrom des rtl_tcp-Servers} auf {address} {broken?true=ist abgebrochen|false=ist zu Ende}.",
    "Sein Funkgerät und das Netz prüfen.",
  ],
  home_not_known: ["Die simulierten Sender stehen um den Startplatz des Fluggeräts, der noch nicht bekannt ist.", "Auf GPS warten."],
  simulator_refused: ["Der simulierte Autopilot lehnte ab: {problem}."],
  simulator_silent: ["Der simulierte Autopilot antwortete auf {order} nicht binnen {waited_s:1}.", "Ihn neu starten."],
} satisfies Partial<ReasonTable>;
