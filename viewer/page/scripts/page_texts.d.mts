export function textsOf(file: string, code?: string): { key: string; where: string }[];
export function untranslated(file: string, code?: string): { text: string; where: string }[];
export function allUntranslated(): { text: string; where: string }[];
