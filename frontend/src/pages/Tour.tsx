// One minute through the screen: each step marks a part of it and says what it is for.
import { useEffect, useState } from "preact/hooks";
import { type MessageKey, t } from "../i18n";
import { type Card, chosenCard } from "../state/card";
import { overlay } from "../state/overlay";
import { change } from "../state/settings";

const STEPS = [1, 2, 3, 4, 5, 6] as const;

/** On the example every part appears in its time; elsewhere only what is there is explained. */
const ofExample = () => new URLSearchParams(location.search).has("tour");
const partOf = (step: number) => document.querySelector(`[data-tour="${step}"]`);
/** Where a phone keeps what a step is about. */
const CARDS: Partial<Record<number, Card>> = { 3: "estimate", 4: "sweep", 5: "plan", 6: "events" };
const CARD = { width: 380, height: 190 };

/** A phone has hold and abort at the foot of the screen: nothing may cover them. */
function ordersTop(): number {
  const top = document.querySelector(".urgents")?.getBoundingClientRect().top ?? 0;
  return top > innerHeight / 2 ? top : innerHeight;
}

function placeCard(box: DOMRect): { left: number; top: number } {
  const left = box.right + 12 + CARD.width < innerWidth ? box.right + 12 : box.left - CARD.width - 12;
  const inside = left >= 8;
  const floor = ordersTop();
  const below = box.bottom + 12 + CARD.height < floor ? box.bottom + 12 : box.top - CARD.height - 12;
  return {
    left: inside ? left : Math.max(8, Math.min(innerWidth - CARD.width - 8, box.left + 8)),
    top: Math.max(8, Math.min(floor - CARD.height - 8, inside ? box.top : below)),
  };
}

export function Tour() {
  const [index, setIndex] = useState(0);
  const [box, setBox] = useState<DOMRect | null>(null);
  const [steps] = useState(() => STEPS.filter((step) => ofExample() || partOf(step)));
  const step = steps[index]!;
  useEffect(() => {
    chosenCard.value = CARDS[step] ?? chosenCard.peek();
    const moved = new ResizeObserver(() => setBox(partOf(step)?.getBoundingClientRect() ?? null));
    const shown = requestAnimationFrame(() => {
      const part = partOf(step);
      if (part) moved.observe(part);
      else setBox(null);
    });
    return () => {
      cancelAnimationFrame(shown);
      moved.disconnect();
    };
  }, [step]);
  const end = () => {
    change("tourSeen", true);
    overlay.value = null;
    if (ofExample()) location.href = location.pathname;
  };
  const at = box ? placeCard(box) : { left: innerWidth / 2 - CARD.width / 2, top: innerHeight / 2 - CARD.height / 2 };
  return (
    <>
      {box && (
        <div class="tour-mark" style={{ left: `${box.left}px`, top: `${box.top}px`, width: `${box.width}px`, height: `${box.height}px` }} />
      )}
      <div class="tour" role="dialog" aria-label={t("menu.tour")} data-testid="tour" style={{ left: `${at.left}px`, top: `${at.top}px` }}>
        <p>{t(`tour.${step}` satisfies MessageKey)}</p>
        <div class="start-row">
          <button type="button" disabled={index === 0} onClick={() => setIndex(index - 1)}>
            {t("tour.back")}
          </button>
          {index < steps.length - 1 ? (
            <button type="button" class="primary" data-testid="tour-next" onClick={() => setIndex(index + 1)}>
              {t("tour.next")}
            </button>
          ) : (
            <button type="button" class="primary" data-testid="tour-end" onClick={end}>
              {t("tour.end")}
            </button>
          )}
        </div>
        <div class="start-row">
          <span class="muted">{t("tour.step", { step: index + 1, count: steps.length })}</span>
          {index < steps.length - 1 && (
            <button type="button" onClick={end}>
              {t("tour.end")}
            </button>
          )}
        </div>
      </div>
    </>
  );
}
