// Reads EXR pictures as Kaustik writes them: one part, lines, unpacked or zipped.
import { inflateSync } from 'node:zlib';

/// Channels by name, each with a value for every pixel; rows from the top.
export function readExr(bytes) {
  if (bytes.readUInt32LE(0) !== 20000630) throw new Error('no EXR picture');
  const header = readHeader(bytes, 8);
  const { channels, compression, width, height } = header;
  const lines = { 0: 1, 2: 1, 3: 16 }[compression];
  if (!lines) throw new Error(`an EXR picture packed in another way: ${compression}`);
  const pixels = Object.fromEntries(channels.map(({ name }) => [name, new Float64Array(width * height)]));
  const stride = channels.reduce((sum, { size }) => sum + size * width, 0);
  const blocks = Math.ceil(height / lines);
  for (let block = 0; block < blocks; ++block) {
    const at = Number(bytes.readBigUInt64LE(header.end + 8 * block));
    const first = bytes.readInt32LE(at) - header.top;
    const packed = bytes.subarray(at + 8, at + 8 + bytes.readUInt32LE(at + 4));
    const size = stride * Math.min(lines, height - first);
    let data = packed.length < size ? unpacked(packed) : packed;
    for (let start = 0, y = first; start < size; ++y)
      for (const { name, size: bytesEach, read } of channels)
        for (let x = 0; x < width; ++x, start += bytesEach) pixels[name][y * width + x] = read(data, start);
  }
  return { width, height, channels: pixels };
}

function readHeader(bytes, at) {
  const text = () => {
    const end = bytes.indexOf(0, at);
    const result = bytes.toString('latin1', at, end);
    at = end + 1;
    return result;
  };
  const header = {};
  while (bytes[at] !== 0) {
    const name = text();
    text(); // its type
    const size = bytes.readUInt32LE(at);
    const value = at + 4;
    if (name === 'channels') {
      header.channels = [];
      for (at = value; bytes[at] !== 0; at += 16) header.channels.push({ name: text(), ...kinds[bytes.readUInt32LE(at)] });
    }
    if (name === 'compression') header.compression = bytes[value];
    if (name === 'dataWindow') {
      const [left, top, right, bottom] = [0, 4, 8, 12].map((i) => bytes.readInt32LE(value + i));
      Object.assign(header, { top, width: right - left + 1, height: bottom - top + 1 });
    }
    at = value + size;
  }
  return { ...header, end: at + 1 };
}

const kinds = {
  0: { size: 4, read: (data, at) => data.readUInt32LE(at) },
  1: { size: 2, read: (data, at) => halfFloat(data.readUInt16LE(at)) },
  2: { size: 4, read: (data, at) => data.readFloatLE(at) },
};

function halfFloat(bits) {
  const [sign, exponent, mantissa] = [bits & 0x8000 ? -1 : 1, (bits >> 10) & 31, bits & 1023];
  if (exponent === 31) return mantissa ? NaN : sign * Infinity;
  return sign * (exponent ? 2 ** (exponent - 15) * (1 + mantissa / 1024) : (2 ** -14 * mantissa) / 1024);
}

/// Bytes are differences, first those at even places, then those at odd ones.
function unpacked(packed) {
  const differences = inflateSync(packed);
  for (let i = 1; i < differences.length; ++i) differences[i] += differences[i - 1] - 128;
  const data = Buffer.alloc(differences.length);
  const half = (data.length + 1) >> 1;
  for (let i = 0; i < data.length; ++i) data[i] = differences[(i & 1 ? half : 0) + (i >> 1)];
  return data;
}
