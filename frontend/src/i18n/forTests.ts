// In unit tests the English sentences are there from the beginning; the page loads them after the safety bar.
import { sayReasonsIn } from "./reasons";
import { reasonsEn } from "./reasons.en";

sayReasonsIn(reasonsEn);
