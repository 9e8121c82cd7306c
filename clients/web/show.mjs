// Shows spheres of metal by three.js with its own table of albedos and with ours, in a browser on
// the same computer, until it is stopped: node show.mjs lut.json [port]

import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname } from 'node:path';
import { file } from './files.mjs';

const KINDS = { '.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript',
    '.json': 'application/json' };

const [table, port = 8000] = process.argv.slice(2);
if (!table) {
    console.error('usage: node show.mjs lut.json [port], see README.md');
    process.exit(2);
}

const server = createServer(async ({ url }, response) => {
    try {
        // Parsing an address resolves its dots, so that it names nothing above the folder.
        const { pathname } = new URL(url, 'http://localhost');
        const contents = await readFile(file(pathname === '/' ? '/spheres.html' : pathname, table));
        response.setHeader('Content-Type', KINDS[extname(pathname) || '.html'] ?? 'text/plain');
        response.end(contents);
    } catch {
        response.writeHead(404).end();
    }
});
server.on('error', error => {
    console.error(`port ${port}: ${error.message}`);
    process.exit(1);
});
server.listen(Number(port), '127.0.0.1', () => {
    console.log(`http://localhost:${server.address().port}/ until Ctrl-C`);
});
