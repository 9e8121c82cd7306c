// What three.js' loaders make of the files of `export lut`, see docs/textures.md: whether a filter
// is linear, and which row is first. Files that differ from ours show what decides it.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { DataUtils, LinearFilter, NearestFilter, NearestMipmapNearestFilter } from 'three';
import { DDSLoader } from 'three/addons/loaders/DDSLoader.js';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';
import { FOLDER } from './harness.mjs';

/// A file's bytes in a buffer of their own, with numbers of 32 bits changed at some places.
function contents(name, changes = {}) {
    const bytes = new Uint8Array(readFileSync(join(FOLDER, 'lut', name)));
    const view = new DataView(bytes.buffer);
    for (const [at, x] of Object.entries(changes)) view.setUint32(Number(at), x, true);
    return bytes.buffer;
}

const TABLE = JSON.parse(readFileSync(join(FOLDER, 'lut', 'lut.json'), 'utf8'));
/// Numbers of the table, whose decimals tell 32 bits apart.
const TEXELS = TABLE.data.map(Math.fround);

function ktx2(changes) {
    const loader = new KTX2Loader();
    // What it asks of a renderer matters to formats in blocks alone.
    loader.workerConfig = {};
    return new Promise((resolve, reject) => {
        loader.parse(contents('lut.ktx2', changes), resolve, reject);
    });
}

test('KTX2Loader: rows as they are, nearest filters by the format', async () => {
    const texture = await ktx2();
    assert.equal(texture.magFilter, NearestFilter);
    assert.equal(texture.minFilter, NearestFilter);
    assert.deepEqual([...texture.image.data].map(DataUtils.fromHalfFloat), TEXELS);
});

test('KTX2Loader: no other number of levels has a linear filter', async () => {
    // levelCount, of which 0 asks a program to make levels.
    const texture = await ktx2({ 40: 0 });
    assert.equal(texture.magFilter, NearestFilter);
    assert.equal(texture.minFilter, NearestMipmapNearestFilter);
});

test('KTX2Loader: blocks have a linear filter', async () => {
    // VK_FORMAT_BC5_UNORM_BLOCK, whose two channels have eight bits.
    const texture = await ktx2({ 12: 141 });
    assert.equal(texture.magFilter, LinearFilter);
    assert.equal(texture.minFilter, LinearFilter);
});

test('EXRLoader: linear filters, and the last row first', () => {
    const { magFilter, minFilter, data: found } = new EXRLoader().parse(contents('lut.exr'));
    assert.equal(magFilter, LinearFilter);
    assert.equal(minFilter, LinearFilter);
    const [rows, columns] = TABLE.axes_slowest_first.map(axis => axis.texels);
    for (let row = 0; row < rows; ++row) {
        for (let column = 0; column < columns; ++column) {
            const at = 4 * ((rows - 1 - row) * columns + column);
            assert.equal(DataUtils.fromHalfFloat(found[at]), TEXELS[2 * (row * columns + column)]);
        }
    }
});

test('DDSLoader reads no floats', context => {
    const said = context.mock.method(console, 'error', () => {});
    assert.equal(new DDSLoader().parse(contents('lut.dds'), true).format, null);
    assert.match(said.mock.calls[0].arguments.join(' '), /Unsupported DXGI_FORMAT code\s+34/);
});
