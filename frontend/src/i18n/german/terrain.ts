// German: files of heights, the ground below, and ways too near to it or too high above it.
import type { ReasonTable } from "../reasons";

const WAY = "{where?way_there=Der Weg dorthin|way_home=Der Heimweg von dort|take_off=Der Start}";

export const terrain = {
  ground_unknown: [
    `${WAY} führt über Boden, dessen Höhe das Gelände nicht kennt.`,
    "Gelände für den ganzen Zaun hochladen oder das Gelände entfernen: Der Boden gilt dann als so hoch wie der Startplatz.",
  ],
  clearance_short: [
    `${WAY} liegt mit {altitude_relative_m} über dem Startplatz nur {clearance_m:1} über dem Boden; nötig sind {least_m:1}.`,
    "Einen anderen Ort wählen oder mehr Höhe über dem Startplatz erlauben.",
  ],
  too_high_above_ground: [
    `${WAY} liegt mit {altitude_relative_m} über dem Startplatz {height_m:1} über dem Boden; erlaubt sind {most_m:1}.`,
    "Einen näheren Ort wählen: Unter einem ebenen Weg fällt der Boden zu weit ab.",
  ],
  not_terrain: [
    "Die Datei ist weder ein GeoTIFF noch ein PMTiles-Archiv.",
    "Ein GeoTIFF mit Höhen (Copernicus GLO-30, SRTM) oder ein PMTiles-Archiv mit Terrarium-Kacheln hochladen.",
  ],
  geotiff_unusable: [
    "Das GeoTIFF ist als Gelände nicht brauchbar: {fault?damaged=Es ist beschädigt oder abgeschnitten|big_endian=Seine Bytes stehen in umgekehrter Folge (big-endian)|sample_type=Seine Werte sind weder ganze Zahlen mit 16 Bit noch Gleitkommazahlen mit 32 Bit|several_bands=Es hat mehr als ein Band|too_many_pixels=Es hat mehr als 40 Millionen Pixel|too_large_tiles=Seine Kacheln sind größer als 4096 Pixel|no_place=Es sagt nicht, wo auf der Erde es liegt|rotated=Seine Zeilen verlaufen nicht von West nach Ost|off_earth=Seine Ecken liegen nicht auf der Erde|too_coarse=Seine Pixel sind größer als ein Kilometer|ellipsoid=Seine Höhen zählen ab dem Ellipsoid, nicht ab dem Meeresspiegel|feet=Seine Höhen sind in Fuß|no_heights=Es enthält keine Höhe}.",
    "{fault?damaged=Die ganze Datei noch einmal kopieren oder laden.|too_many_pixels=Den Teil ausschneiden, in dem Sie fliegen, zum Beispiel mit `gdal_translate -projwin`.|ellipsoid=Höhen über dem Geoid nehmen (EGM96 oder EGM2008).|no_heights=Eine Datei nehmen, die das Gebiet enthält.|*=Umwandeln mit `gdalwarp -t_srs EPSG:4326 -ot Float32 -co COMPRESS=DEFLATE`.}",
  ],
  other_coordinate_system: [
    "Das GeoTIFF ist nicht in Länge und Breite (EPSG:4326){epsg?none=|*=, sondern in einem anderen System}.",
    "Umwandeln mit `gdalwarp -t_srs EPSG:4326`.",
  ],
  terrarium_unusable: [
    "Das PMTiles-Archiv ist als Gelände nicht brauchbar: {fault?vector=Es enthält Vektorkacheln|picture_type=Seine Kacheln sind weder PNG noch verlustfreies WebP|tile_size=Seine Kacheln sind keine Quadrate von 256 oder 512 Pixeln|damaged=Eine Kachel ist nicht lesbar|no_heights=Seine Kacheln enthalten keine Höhen in der Terrarium-Kodierung}.",
    "Ein Archiv mit Terrarium-Kacheln hochladen (Höhe = Rot * 256 + Grün + Blau / 256 - 32768).",
  ],
  heights_implausible: [
    "Die Höhen der Datei reichen von {lowest_m} bis {highest_m}; das gibt es auf der Erde nicht.",
    "Prüfen, ob sie Höhen in Metern enthält und ihren Wert für fehlende Daten nennt.",
  ],
  terrain_too_large: ["Die Datei ist größer als {most_bytes}.", "Den Teil ausschneiden, in dem Sie fliegen."],
  terrain_label_damaged: ["{file}: Dieses Gelände ist nicht mehr lesbar.", "Löschen und noch einmal hochladen."],
  no_terrain: [
    "Kein Gelände: Der Boden gilt überall als so hoch wie der Startplatz.",
    "Gelände des Gebiets hochladen oder sicherstellen, dass darin nichts bis nahe an die Flughöhe aufragt.",
  ],
  terrain_covers: [
    "Das Gelände reicht über den ganzen Zaun, eine Höhe alle {spacing_m}; der höchste Boden liegt {highest_above_home_m} über dem Startplatz.",
  ],
  terrain_partly: [
    "Das Gelände reicht nur über {known_percent} des Zauns; Wege über den Rest werden abgelehnt.",
    "Gelände für alles hochladen oder es entfernen.",
  ],
  home_height_differs: [
    "Das Gelände hat den Startplatz auf {terrain_m:0} über dem Meer, der Autopilot auf {autopilot_m:0}; jeder Weg hält nach beiden Abstand vom Boden.",
    "Auf besseren GPS-Empfang warten und am Startplatz neu scharf schalten, oder prüfen, ob die Höhen des Geländes Meter über dem Meer sind.",
  ],
  ground_not_kept: [
    "Das Gelände ließ sich nicht mit der Mission speichern: {detail}.",
    "Platz auf der Festplatte schaffen, dann noch einmal starten.",
  ],
} satisfies Partial<ReasonTable>;
