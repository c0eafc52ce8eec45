import { paletteBytes } from './color';

/// By what photons are coloured, and told apart in the legend.
export const photonColours = ['kind', 'lamp', 'level'] as const;
export type PhotonColour = (typeof photonColours)[number];

/// One colour of the legend.
export interface PhotonClass {
  title: string;
  colour: readonly [number, number, number]; // bytes
  count: number;
}

interface Head {
  count: number;
  total: number;
  key: string;
  kinds: string[];
  lamps: string[];
}

const bytesEach = 28;
const kindTitles: Record<string, string> = { global: 'Indirect', caustic: 'Caustic', volume: 'In media' };
const kindColours = { caustic: [255, 179, 71], global: [95, 170, 255], volume: [214, 140, 255] } as const;
const lampColours = [
  [255, 190, 60], [90, 180, 240], [90, 215, 150], [255, 120, 140], [200, 150, 255], [240, 228, 90], [255, 150, 90], [150, 215, 215],
] as const;
const mostLamps = lampColours.length; // the last colour is that of all others, too
const mostLevels = 8; // the last is "so many or more"

/// Photons that the server sent: where they lie, and what class they belong to.
export class PhotonCloud {
  private constructor(
    readonly head: Head,
    readonly positions: Float32Array, // m, three for each
    private readonly kinds: Uint8Array,
    private readonly lamps: Uint16Array,
    private readonly levels: Uint8Array,
  ) {}

  static read(bytes: ArrayBuffer): PhotonCloud {
    const view = new DataView(bytes);
    const start = 4 + view.getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, start - 4))) as Head;
    const { count } = head;
    if (bytes.byteLength !== start + count * bytesEach)
      throw new Error(`${count} photons came with ${bytes.byteLength} bytes`);
    const positions = new Float32Array(3 * count);
    const [kinds, lamps, levels] = [new Uint8Array(count), new Uint16Array(count), new Uint8Array(count)];
    for (let i = 0; i < count; ++i) {
      const at = start + i * bytesEach;
      for (let axis = 0; axis < 3; ++axis) positions[3 * i + axis] = view.getFloat32(at + 4 * axis, true);
      kinds[i] = view.getUint8(at + 24);
      levels[i] = view.getUint8(at + 25);
      lamps[i] = view.getUint16(at + 26, true);
    }
    return new PhotonCloud(head, positions, kinds, lamps, levels);
  }

  /// The class of each photon, an index into classes().
  classOf(by: PhotonColour): (photon: number) => number {
    if (by === 'kind') return (i) => this.kinds[i]!;
    if (by === 'lamp') return (i) => Math.min(this.lamps[i]!, mostLamps - 1);
    return (i) => Math.min(this.levels[i]!, mostLevels);
  }

  classes(by: PhotonColour): PhotonClass[] {
    const classes = this.emptyClasses(by);
    const classOf = this.classOf(by);
    for (let i = 0; i < this.head.count; ++i) classes[classOf(i)]!.count += 1;
    return classes;
  }

  private emptyClasses(by: PhotonColour): PhotonClass[] {
    const { kinds, lamps } = this.head;
    if (by === 'kind')
      return kinds.map((kind) => ({ title: kindTitles[kind] ?? kind, colour: kindColours[kind as keyof typeof kindColours] ?? [255, 255, 255], count: 0 }));
    if (by === 'lamp')
      return lamps.slice(0, mostLamps).map((name, i) => ({
        title: i + 1 === mostLamps && lamps.length > mostLamps ? `${lamps.length - i} others` : name,
        colour: lampColours[i]!,
        count: 0,
      }));
    const palette = paletteBytes(false);
    return Array.from({ length: mostLevels + 1 }, (_, level) => {
      // The palette's dark end would be lost on dark pictures.
      const at = 4 * Math.round(90 + (level / mostLevels) * 165);
      return {
        title: level === mostLevels ? `${level} or more` : String(level),
        colour: [palette[at]!, palette[at + 1]!, palette[at + 2]!] as const,
        count: 0,
      };
    });
  }
}
