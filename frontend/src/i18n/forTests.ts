// In unit tests the English words are all there from the beginning; the page loads most after the safety bar.
import { sayWordsIn } from ".";
import { en } from "./en";
import { pagesEn } from "./pages.en";
import { sayReasonsIn } from "./reasons";
import { reasonsEn } from "./reasons.en";

sayWordsIn({ ...en, ...pagesEn });
sayReasonsIn(reasonsEn);
