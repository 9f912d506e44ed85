// SPDX-License-Identifier: GPL-3.0-or-later
// Rules for TypeScript and for the scripts. Prettier owns the layout; what is left here is naming, size and mistakes.
import js from '@eslint/js';
import prettier from 'eslint-config-prettier';
import globals from 'globals';
import ts from 'typescript-eslint';

const size = {
  'max-lines': ['error', { max: 300, skipComments: true }],
  'max-lines-per-function': ['error', { max: 60, skipComments: true, skipBlankLines: true }],
  'max-len': ['error', { code: 120, ignoreUrls: true }],
};

const naming = [
  'error',
  { selector: 'default', format: ['camelCase'], leadingUnderscore: 'allow' },
  { selector: 'import', format: ['camelCase', 'PascalCase', 'UPPER_CASE'] },
  { selector: 'typeLike', format: ['PascalCase'] },
  // Messages, bundles and HTTP carry the names of their formats.
  { selector: ['objectLiteralProperty', 'objectLiteralMethod', 'typeProperty'], format: null },
];

export default ts.config(
  { ignores: ['dist/', 'node_modules/', 'src/lcm.ts'] },
  js.configs.recommended,
  {
    files: ['**/*.ts'],
    extends: [ts.configs.recommended],
    languageOptions: { parserOptions: { projectService: { allowDefaultProject: ['*.config.ts'] } } },
    rules: {
      '@typescript-eslint/naming-convention': naming,
      // Indices are checked by the loops that make them.
      '@typescript-eslint/no-non-null-assertion': 'off',
    },
  },
  {
    files: ['**/*.mjs', '**/*.js'],
    languageOptions: { globals: { ...globals.node, ...globals.browser } },
    rules: { camelcase: ['error', { properties: 'never', ignoreDestructuring: true }] },
  },
  { rules: { ...size, 'one-var': ['error', 'never'], eqeqeq: ['error', 'smart'], 'prefer-const': 'error' } },
  // A describe block is a list of tests, not a function.
  { files: ['test/*.test.ts'], rules: { 'max-lines-per-function': 'off' } },
  prettier,
  { rules: { 'max-len': size['max-len'] } },
);
