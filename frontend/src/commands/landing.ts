// Landing where the vehicle is: the last resort, so it is confirmed by a slide, which a button or a key brings up.
import { signal } from "@preact/signals";

export const landingArmed = signal(false);
