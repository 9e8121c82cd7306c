// The counts of docs/shaders.md are those of the exported functions.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';

import { table } from './cost.mjs';

test('operations of functions in docs/shaders.md', () => {
    const docs = fs.readFileSync(path.join(import.meta.dirname, '../../docs/shaders.md'), 'utf8');
    for (const line of table(path.join(process.env.PAGES, 'cost'))) {
        assert.ok(docs.includes(`\n${line}\n`), `docs/shaders.md has no line ${line}`);
    }
});
