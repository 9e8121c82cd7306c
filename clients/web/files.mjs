// What the addresses of pages that use three.js stand for: this folder, three.js from npm's, and a
// table of albedos.

import { join } from 'node:path';

/// The file at the path of an address; `table` is what `export lut --format json` wrote.
export function file(pathname, table) {
    if (pathname === '/table.json') return table;
    const path = pathname.startsWith('/three/')
        ? join('node_modules/three/build', pathname.slice('/three/'.length))
        : pathname.slice(1);
    return join(import.meta.dirname, path);
}
