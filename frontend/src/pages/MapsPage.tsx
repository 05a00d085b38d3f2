// Offline maps and overlays on this server: add, choose, check, remove. Nothing comes from outside.
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { reasonText, t } from "../i18n";
import { basemap, chooseBasemap } from "../map/basemap";
import { overlayIds, showOverlay } from "../map/overlays";
import { ProblemBox } from "../panels/ProblemNote";
import { Upload } from "../panels/Upload";
import * as maps from "../sources/mapsApi";
import { deleteTerrain, listTerrain, type TerrainList } from "../sources/terrainApi";
import { settings } from "../state/settings";
import { formatLength, formatNumber } from "../units/quantities";
import type { Problem } from "../wire";

function Packages({ list, onChange }: { list: maps.MapList; onChange: () => void }) {
  return (
    <ul class="cards">
      <li class="card">
        <label class="check">
          <input type="radio" name="basemap" checked={basemap.value === null} onChange={() => chooseBasemap(null)} />
          {t("maps.plain")}
        </label>
      </li>
      {list.maps.map((map) => (
        <li class="card" key={map.map_id} data-testid="map-package">
          <label class="check">
            <input type="radio" name="basemap" checked={basemap.value === map.map_id} onChange={() => chooseBasemap(map.map_id)} />
            <strong>{map.name}</strong>
          </label>
          <span class="muted">
            {t("maps.size", { size: formatNumber(map.size_bytes / 1e6, 1), minimum: map.min_zoom, maximum: map.max_zoom })}{" "}
            {map.attribution}
          </span>
          <button
            type="button"
            onClick={() => {
              if (basemap.peek() === map.map_id) chooseBasemap(null);
              void maps.deleteMap(map.map_id).then(onChange, onChange);
            }}
          >
            {t("maps.remove")}
          </button>
        </li>
      ))}
    </ul>
  );
}

function Overlays({ list, onChange }: { list: maps.OverlayList; onChange: () => void }) {
  return (
    <ul class="cards">
      {list.overlays.map((one) => (
        <li class="card" key={one.overlay_id} data-testid="overlay">
          <label class="check">
            <input
              type="checkbox"
              checked={overlayIds.value.includes(one.overlay_id)}
              onChange={(e) => showOverlay(one.overlay_id, e.currentTarget.checked)}
            />
            <strong>{one.name}</strong>
          </label>
          <span class="muted">
            {t("maps.features", { count: one.features })} {one.notes.map(reasonText).join(" ")}
          </span>
          <button
            type="button"
            onClick={() => {
              showOverlay(one.overlay_id, false);
              void maps.deleteOverlay(one.overlay_id).then(onChange, onChange);
            }}
          >
            {t("maps.remove")}
          </button>
        </li>
      ))}
    </ul>
  );
}

function Terrain({ list, onChange }: { list: TerrainList; onChange: () => void }) {
  return (
    <ul class="cards">
      {list.terrains.map((one) => (
        <li class="card" key={one.terrain_id} data-testid="terrain">
          <strong>{one.name}</strong>
          <span class="muted">
            {t("maps.terrainSize", {
              size: formatNumber(one.size_bytes / 1e6, 1),
              spacing: formatLength(one.spacing_m, settings.value.units),
            })}
          </span>
          <button type="button" onClick={() => void deleteTerrain(one.terrain_id).then(onChange, onChange)}>
            {t("maps.remove")}
          </button>
        </li>
      ))}
      {list.unusable.map((reason, i) => (
        <li class="refused" key={i}>
          {reasonText(reason)}
        </li>
      ))}
    </ul>
  );
}

export function MapsPage() {
  const [packages, setPackages] = useState<maps.MapList | null>(null);
  const [overlays, setOverlays] = useState<maps.OverlayList | null>(null);
  const [terrain, setTerrain] = useState<TerrainList | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const read = () => {
    Promise.all([maps.listMaps(), maps.listOverlays(), listTerrain()]).then(
      ([listed, drawn, heights]) => {
        setPackages(listed);
        setOverlays(drawn);
        setTerrain(heights);
      },
      (error: unknown) => setProblem(asProblem(error)),
    );
  };
  useEffect(() => {
    read();
  }, []);
  return (
    <div class="page" data-testid="maps-page">
      <div class="page-head">
        <h1>{t("maps.title")}</h1>
        <Upload path="/maps" testId="upload-maps" accept=".pmtiles" label={t("maps.upload")} onDone={read} onProblem={setProblem} />
      </div>
      <p>{t("maps.explain")}</p>
      {problem && <ProblemBox problem={problem} />}
      {packages && <Packages list={packages} onChange={read} />}
      {packages?.unusable.map((reason, i) => (
        <p class="refused" key={i}>
          {reasonText(reason)}
        </p>
      ))}
      <div class="page-head">
        <h1>{t("maps.terrain")}</h1>
        <Upload
          path="/terrain"
          testId="upload-terrain"
          accept=".tif,.tiff,.pmtiles"
          label={t("maps.uploadTerrain")}
          onDone={read}
          onProblem={setProblem}
        />
      </div>
      <p>{t("maps.terrainExplain")}</p>
      {terrain && <Terrain list={terrain} onChange={read} />}
      <div class="page-head">
        <h1>{t("maps.overlays")}</h1>
        <Upload
          path="/overlays"
          testId="upload-overlays"
          accept=".geojson,.json,.kml,.kmz"
          label={t("maps.uploadOverlay")}
          onDone={read}
          onProblem={setProblem}
        />
      </div>
      <p>{t("maps.overlaysExplain")}</p>
      {overlays && <Overlays list={overlays} onChange={read} />}
      {overlays?.unusable.map((reason, i) => (
        <p class="refused" key={i}>
          {reasonText(reason)}
        </p>
      ))}
    </div>
  );
}
