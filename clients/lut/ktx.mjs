// Prints what ktx-parse finds in a KTX 2 file: its header, its texels, and its description.
import { readFileSync } from "node:fs";
import { read } from "ktx-parse";

const file = read(readFileSync(process.argv[2]));
const size = [file.pixelWidth, file.pixelHeight, file.pixelDepth];
const texels = Buffer.from(file.levels[0].levelData).toString("base64");
const dfd = file.dataFormatDescriptor[0];
const channels = dfd.samples.map((s) => [s.channelType, s.bitOffset, s.bitLength]);
const text = new TextDecoder();
const keys = Object.fromEntries(
    Object.entries(file.keyValue).map(([key, value]) => [
        key,
        typeof value === "string" ? value : text.decode(value).replace(/\0$/, ""),
    ]),
);
console.log(JSON.stringify({ format: file.vkFormat, size, texels, channels, keys }));
