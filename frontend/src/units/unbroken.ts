/** A number and its unit stay on one line, where a narrow column would break between them. */
export const unbroken = (text: string): string => text.replace(/(\d) (?=(?:m|m²|km|ft|mi|s|%)(?![\p{L}\d²]))/gu, "$1\u00a0");
