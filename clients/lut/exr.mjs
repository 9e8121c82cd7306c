// Prints what three.js's loader finds in an OpenEXR file: its size, and its texels as they are.
import { readFileSync } from "node:fs";
import { FloatType } from "three";
import { EXRLoader } from "three/addons/loaders/EXRLoader.js";

const bytes = readFileSync(process.argv[2]);
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
const { width, height, data } = new EXRLoader().setDataType(FloatType).parse(buffer);
const texels = Buffer.from(data.buffer, data.byteOffset, data.byteLength).toString("base64");
console.log(JSON.stringify({ size: [width, height], texels }));
