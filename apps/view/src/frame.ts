import type { FrameFormat, Vec3 } from './protocol';
import { luminance } from './color';

/// One picture that the server sent. Rows go from the top.
export class Frame {
  private constructor(
    readonly number: number,
    readonly revision: number,
    readonly kind: string,
    readonly passes: number,
    readonly width: number,
    readonly height: number,
    readonly scale: number, // pixels times this are the values
    readonly isMoving: boolean,
    readonly projection: readonly number[] | null, // from the world to pixels of the whole picture, 3 rows of 4
    readonly layer: string,
    readonly format: FrameFormat,
    readonly pixels: Uint32Array | Float32Array,
  ) {}

  static async read(response: Response, layer: string, format: FrameFormat): Promise<Frame> {
    const number = (name: string) => Number(response.headers.get(name) ?? NaN);
    const width = number('X-Width');
    const height = number('X-Height');
    const bytes = await response.arrayBuffer();
    const size = width * height * (format === 'rgb9e5' ? 4 : 12);
    if (!(size > 0) || bytes.byteLength !== size)
      throw new Error(`a picture of ${width} × ${height} pixels came with ${bytes.byteLength} bytes`);
    return new Frame(
      number('X-Number'),
      number('X-Revision'),
      response.headers.get('X-Kind') ?? '',
      number('X-Passes'),
      width,
      height,
      Number(response.headers.get('X-Scale') ?? 1),
      response.headers.get('X-Moving') === '1',
      projectionOf(response),
      layer,
      format,
      format === 'rgb9e5' ? new Uint32Array(bytes) : new Float32Array(bytes),
    );
  }

  /// The value of a pixel of this frame.
  rgb(x: number, y: number): Vec3 {
    const i = y * this.width + x;
    if (this.pixels instanceof Float32Array) {
      const at = (c: number) => this.pixels[3 * i + c]! * this.scale;
      return [at(0), at(1), at(2)];
    }
    const bits = this.pixels[i]!;
    const unit = 2 ** ((bits >>> 27) - 24) * this.scale;
    return [(bits & 511) * unit, ((bits >>> 9) & 511) * unit, ((bits >>> 18) & 511) * unit];
  }

  /// Luminances of some thousand pixels, evenly over the picture.
  someLuminances(most = 20000): Float64Array {
    const step = Math.max(1, Math.ceil(Math.sqrt((this.width * this.height) / most)));
    const result: number[] = [];
    for (let y = step >> 1; y < this.height; y += step)
      for (let x = step >> 1; x < this.width; x += step) result.push(luminance(this.rgb(x, y)));
    return Float64Array.from(result);
  }
}

/// Null: the camera has none.
function projectionOf(response: Response): number[] | null {
  const numbers = (response.headers.get('X-Projection') ?? '').split(' ').map(Number);
  return numbers.length === 12 && numbers.every(Number.isFinite) ? numbers : null;
}
