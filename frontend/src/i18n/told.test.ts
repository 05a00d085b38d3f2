import { afterEach, expect, it } from "vitest";
import table from "./told.json";
import { sentencesOf, tellIn, tellInUnits, told, toldName, toldReason, translated } from "./told";

afterEach(() => {
  tellIn(null);
  tellInUnits("metric");
});

it("says in English what the server said, names with a capital", () => {
  expect(told("the vehicle has no position")).toBe("the vehicle has no position");
  expect(toldName("antenna pattern")).toBe("Antenna pattern");
  expect(toldName("Failsafe NAV_DLL_ACT")).toBe("Failsafe NAV_DLL_ACT");
  expect(toldName("safety: no_fly")).toBe("Safety: no fly");
  expect(toldName("GPS")).toBe("GPS");
  expect(toldReason("not yet: no bearing taken")).toBe("no bearing taken");
});

it("puts the values of a sentence into its translation, sentences within sentences too", () => {
  tellIn(table);
  expect(toldReason("not yet: expected error 31 m, wanted below 10 m")).toBe("erwarteter Fehler 31 m, gewünscht unter 10 m");
  expect(told("not yet: both bearings from one side, crossing at 12 deg, 20 deg are needed")).toBe(
    "noch nicht: beide Peilungen von einer Seite, Schnittwinkel 12°, 20° sind nötig",
  );
  expect(told("no usable bearing here: quality 0.41 is below 0.70")).toBe("hier keine brauchbare Peilung: Güte 0,41 liegt unter 0,70");
  expect(told("receiver: silent for 6 s")).toBe("Empfänger: seit 6 s stumm");
  expect(told("not localized after 20 places (not yet: no bearing taken; not yet: 2 of 5 bearings contradict the estimate, another look is needed)")).toBe(
    "nicht gefunden nach 20 Orten (noch nicht: keine Peilung genommen; noch nicht: 2 von 5 Peilungen widersprechen der Schätzung, es braucht noch einen Blick)",
  );
  expect(toldName("safety: no_fly")).toBe("Sicherheit: Flugverbot");
  expect(told("a.csv: no usable pulse of tag 3 in any rotation; first remark: a.csv:2: a pulse needs 19 columns, this row has 7; line left out")).toBe(
    "a.csv: kein brauchbarer Puls der Kennung 3 in irgendeiner Drehung; erste Bemerkung: a.csv:2: ein Puls braucht 19 Spalten, diese Zeile hat 7; Zeile ausgelassen",
  );
});

it("gives the server's values in the operator's units", () => {
  expect(told("135181 m2 to fly in")).toBe("0.14 km² to fly in");
  expect(told("expected error 31 m, wanted below 10 m")).toBe("expected error 31 m, wanted below 10 m");
  tellInUnits("imperial");
  expect(told("135181 m2 to fly in")).toBe("33.40 acres to fly in");
  expect(told("not yet: expected error 31 m, wanted below 10 m")).toBe("not yet: expected error 102 ft, wanted below 32.8 ft");
  expect(told("wind of 12.5 m/s; 20 MHz, 30 mm, 4 m2s")).toBe("wind of 28.0 mph; 20 MHz, 30 mm, 4 m2s");
  tellIn(table);
  expect(told("135181 m2 to fly in")).toBe("33.40 acres Flugraum");
});

it("knows a sentence that the server began with a capital and ended with a dot", () => {
  tellIn(table);
  expect(told("The area has only 7 m2.")).toBe("Das Gebiet hat nur 7 m².");
  expect(told("Draw at least 100 m2.")).toBe("Mindestens 100 m² zeichnen.");
  expect(told("The moon is in the way.")).toBe("The moon is in the way.");
});

it("knows what is wrong with a file or a receiver, alone, in an alert and as a refusal's sentence", () => {
  tellIn(table);
  expect(told("receiver: turn.sigmf-meta: was recorded at 433.9200 MHz, not near 151.0000 MHz")).toBe(
    "Empfänger: turn.sigmf-meta: aufgenommen auf 433,9200 MHz, nicht in der Nähe von 151,0000 MHz",
  );
  expect(told("preflight: receiver: the receiver delivered nothing for 5 s; check its cable and driver")).toBe(
    "Prüfung vor dem Start: Empfänger: der Empfänger lieferte 5 s lang nichts; sein Kabel und seinen Treiber prüfen",
  );
  expect(told("receiver: the sample rate is 0.0 Hz; it must be greater than zero")).toBe(
    "Empfänger: die Abtastrate ist 0,0 Hz; sie muss größer als null sein",
  );
  expect(told('the receiver "x" is not understood; write soapy:driver=NAME[,key=value], rtl_tcp://HOST[:PORT], sigmf:FILE or recording:FILE')).toBe(
    "die Angabe „x“ für den Empfänger ist nicht zu verstehen; so schreiben: soapy:driver=NAME[,key=value], rtl_tcp://HOST[:PORT], sigmf:FILE oder recording:FILE",
  );
  expect(told("a.sigmf: 433.9200 MHz does not fit into 250 kS/s around 151.0000 MHz; tune closer, or raise the sample rate (core:sample_rate, core:frequency)")).toBe(
    "a.sigmf: 433,9200 MHz passt nicht in 250 kS/s um 151,0000 MHz; näher daran abstimmen oder die Abtastrate erhöhen (core:sample_rate, core:frequency)",
  );
  expect(told("Turn 1.sigmf-meta: is silent: every sample is zero; was the receiver running?.")).toBe(
    "Turn 1.sigmf-meta: ist stumm: jeder Abtastwert ist null; lief der Empfänger?",
  );
  expect(told("2026-05-01.sigmf-meta: the headings run from -9.0 to -1.0 s after its beginning, the samples from 0 to 8.0 s; check the times and the sample rate (8000 Hz).")).toBe(
    "2026-05-01.sigmf-meta: die Kurse reichen von -9,0 bis -1,0 s nach Beginn der Aufnahme, die Abtastwerte von 0 bis 8,0 s; die Zeiten und die Abtastrate (8000 Hz) prüfen.",
  );
  expect(told("A pulse of 0.5 s every 0.1 s cannot be: give 0 < width_s < period_s.")).toBe(
    "Einen Puls von 0,5 s alle 0,1 s kann es nicht geben: nötig ist 0 < width_s < period_s.",
  );
  expect(told("Upload a UAV-RT rotation file, a CSV of heading_deg and power_db, or SigMF.")).toBe(
    "Hochladen: eine UAV-RT-Datei, ein CSV mit heading_deg und power_db oder SigMF.",
  );
});

it("shows a sentence that it does not know as it came", () => {
  tellIn(table);
  expect(told("the moon is in the way")).toBe("the moon is in the way");
});

it("takes every sentence for itself and not for a vaguer one", () => {
  const known = sentencesOf(table);
  for (const [english, german] of Object.entries(table)) {
    const filled = english.replaceAll("{}", "7");
    const wanted = german.replace(/\{\d\}/g, "7");
    expect(translated(filled, known), english).toBe(wanted);
  }
});
