/** A tap that comes sooner was meant for what was there before, or is a thumb's second one. */
export const TAP_MS = 600;
