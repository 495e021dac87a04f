// The programs of a page of docs/: its ```js blocks, each with the ```text that says what it prints.
import {readFileSync} from 'node:fs';

export function examples(page) {
  const text = readFileSync(page, 'utf8');
  const found = [...text.matchAll(/```js\n(.*?)```\n+```text\n(.*?)```/gs)].map(([, program, prints]) => ({program, prints}));
  const programs = text.match(/```js\n/g)?.length ?? 0;
  if (programs === 0 || found.length !== programs) throw new Error(`${page}: ${programs} programs, ${found.length} with what they print`);
  return found;
}
