export const languages: string[];
export function catalogue(language: string): Record<string, string>;
export function allTexts(): { key: string; where: string }[];
export function exerciseTexts(): { key: string; kind: string }[];
export function missing(language: string): string[];
export function stale(language: string): string[];
export function builtProgram(): string;
export function exercisesChanged(program: string): boolean;
export function htmlOf(page: string): string;
