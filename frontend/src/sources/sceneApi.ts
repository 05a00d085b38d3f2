// What this tab's 3D scene shows.
import type { components } from "../wire/generated";
import { json, withBody } from "./api";

type Schemas = components["schemas"];
export type SceneRequest = Schemas["SceneRequest"];
export type SceneView = Schemas["SceneView"];

export const showScene = (viewId: string, request: SceneRequest) => json<SceneView>(`/scene/views/${viewId}`, withBody("PUT", request));
