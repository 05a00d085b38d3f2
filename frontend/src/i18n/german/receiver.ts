// German: receivers, channels and radios.
import type { ReasonTable } from "../reasons";

const DEVICE = "soapy:driver=NAME[,key=value], rtl_tcp://HOST[:PORT], sigmf:FILE oder recording:FILE";

export const receiver = {
  receiver_misnamed: {
    text: "Die Angabe „{device}“ für den Empfänger {fault?form=ist nicht zu verstehen|host=nennt keinen Rechner|port=nennt einen Port, der keine Zahl von 1 bis 65535 ist|driver=nennt keinen Treiber|server=nennt keinen Server}.",
    remedy: `So schreiben: {fault?form=${DEVICE}|host=rtl_tcp://HOST[:PORT]|port=rtl_tcp://HOST[:PORT]|driver=zum Beispiel driver=rtlsdr; eine Suche ohne Treiber würde das Netz abfragen|server=driver=remote,remote=tcp://HOST:PORT; eine Suche nach Servern würde das Netz abfragen}.`,
  },
  receiver_not_open: { text: "Der Empfänger ist nicht geöffnet.", remedy: "Ihn zuerst mit seinen Kanälen öffnen." },
  receiver_silent: {
    text: "Der Empfänger hat seit {quiet_s} nichts geliefert.",
    remedy: "Kabel und Treiber prüfen, ebenso, ob ein anderes Programm ihn benutzt.",
  },
  nothing_heard_in_turn: {
    text: "Der Empfänger lieferte während der Drehung nichts.",
    remedy: "Prüfen, ob er läuft und abgestimmt ist.",
  },
  receiver_stream_ended: {
    text: "Der Datenstrom des Empfängers ist zu Ende.",
    remedy: "Nach dem Funkgerät sehen oder die Aufnahme noch einmal abspielen.",
  },
  receiver_unplugged: { text: "Der Empfänger wurde abgezogen.", remedy: "Ihn wieder anstecken." },
  samples_lost: {
    text: "Der Empfänger verlor {lost_percent} seiner Abtastwerte.",
    remedy: "Prüfen, ob er noch verbunden ist; ist dieser Rechner zu langsam für ihn, die Abtastrate senken.",
  },
  nonsensical_power: {
    text: "Der Empfänger liefert eine Leistung von {value} dB, die es nicht geben kann; solche Messwerte werden ausgelassen.",
    remedy: "Den Empfänger und seinen Treiber prüfen.",
  },
  recorded_sweep_empty: { text: "Die aufgenommene Drehung enthält keinen Messwert.", remedy: "Eine andere Aufnahme angeben." },

  no_channel: { text: "Vom Empfänger wurde kein Kanal verlangt.", remedy: "Mindestens einen Sender mit seiner Frequenz nennen." },
  frequency_out_of_range: {
    text: "Der Empfänger lässt sich nicht auf {frequency_hz} abstimmen.",
    remedy: "Die Frequenz des Senders prüfen oder einen anderen Empfänger benutzen.",
  },
  frequency_twice: {
    text: "{frequency_hz} wurde vom Empfänger zweimal verlangt; er könnte die beiden Sender nicht unterscheiden.",
    remedy: "Einen nach dem anderen suchen.",
  },
  frequency_not_asked_for: {
    text: "Der Empfänger liefert Messwerte auf {frequency_hz}, die niemand verlangt hat.",
    remedy: "Den Empfänger neu starten.",
  },
  carriers_only: {
    text: "Dieser Empfänger misst nur Träger, der Sender auf {frequency_hz} aber pulst.",
    remedy: "Einen Empfänger benutzen, der IQ liefert.",
  },
  one_channel_only: {
    text: "Dieser Empfänger hört immer nur einen Sender; verlangt wurden {asked}.",
    remedy: "Einen nach dem anderen suchen oder einen Empfänger benutzen, der IQ liefert.",
  },
  band_too_narrow: {
    text: "Mit einer Abtastrate von {sample_rate_hz} kann der Empfänger {refused_hz} nicht zugleich mit den anderen hören.",
    remedy:
      "Die Abtastrate auf {needed_hz} erhöhen oder in der Mission angeben, wie breit das Band des Empfängers ist: Dann hört er sie nacheinander.",
  },
  outside_band: {
    text: "Eine Abtastrate von {sample_rate_hz} um {centre_hz} reicht nicht bis {refused_hz}.",
    remedy: "Näher daran abstimmen oder die Abtastrate erhöhen.",
  },
  recorded_elsewhere: {
    text: "Die Aufnahme entstand auf {recorded_hz}, nicht auf {wanted_hz}.",
    remedy: "Die Frequenz des Senders wie in der Aufnahme nennen oder eine andere Aufnahme angeben.",
  },
  sample_rate_too_low: {
    text: "Eine Abtastrate von {sample_rate_hz} ist zu niedrig.",
    remedy: "Die Abtastrate auf mindestens {needed_hz} erhöhen.",
  },
  impossible_pulses: {
    text: "Einen Puls von {width_s:3} alle {period_s:3} kann es nicht geben.",
    remedy: "Eine Breite größer als null und kleiner als die Periode angeben.",
  },

  soapy_missing: {
    text: "SoapySDR ist für dieses Python nicht installiert.",
    remedy:
      "Das Systempaket python3-soapysdr (und das Modul des Funkgeräts) installieren und SoapySDR.py in dieser Umgebung sichtbar machen (wie, sagt das Benutzerhandbuch) oder einen Empfänger mit rtl_tcp:// verwenden.",
  },
  radio_failed: {
    text: "Das Funkgerät „{device}“ {stage?call=meldet einen Fehler|start=startet nicht|read=liefert nichts mehr} ({says}).",
    remedy: "Geräteangabe und Kabel prüfen.",
  },
  no_receive_channel: {
    text: "Das Funkgerät „{device}“ hat keinen Empfangskanal.",
    remedy: "Ein Funkgerät benutzen, das empfangen kann.",
  },
  tuned_elsewhere: {
    text: "Das Funkgerät „{device}“ stimmte auf {tuned_hz} statt auf {wanted_hz} ab.",
    remedy: "Prüfen, ob das in seinem Bereich liegt.",
  },
  rtl_sdr_sample_rate: {
    text: "Ein RTL-SDR kann nicht mit {sample_rate_hz} abtasten.",
    remedy: "225001 bis 300000 oder 900001 bis 3200000 Abtastwerte in der Sekunde wählen.",
  },
  rtl_tcp_unreachable: { text: "Der rtl_tcp-Server auf {address} ist nicht erreichbar ({detail}).", remedy: "Ihn dort starten." },
  rtl_tcp_busy: {
    text: "Der rtl_tcp-Server auf {address} {closed?true=hat die Verbindung geschlossen|false=antwortet nicht}.",
    remedy: "Prüfen, ob er läuft und kein anderes Programm damit verbunden ist.",
  },
  not_rtl_tcp: { text: "Das Programm, das auf {address} antwortet, ist kein rtl_tcp-Server.", remedy: "Die Adresse berichtigen." },
  rtl_tcp_ended: {
    text: "{broken?true=Die Verbindung zum rtl_tcp-Server|false=Der Datenstrom des rtl_tcp-Servers} auf {address} {broken?true=ist abgebrochen|false=ist zu Ende}.",
    remedy: "Sein Funkgerät und das Netz prüfen.",
  },
  home_not_known: {
    text: "Die simulierten Sender stehen um den Startplatz des Fluggeräts, der noch nicht bekannt ist.",
    remedy: "Auf GPS warten.",
  },
  simulator_refused: { text: "Der simulierte Autopilot lehnte ab: {problem}.", remedy: "" },
  simulator_silent: {
    text: "Der simulierte Autopilot antwortete auf {order} nicht binnen {waited_s:1}.",
    remedy: "Ihn neu starten.",
  },
} satisfies Partial<ReasonTable>;
