import { paletteBytes } from './color';
import type { Frame } from './frame';
import { linked } from './gl';
import type { Operator } from './layers';
import type { Scale } from './scale';
import { fragmentShader, vertexShader } from './shaders';

export interface Look {
  operator: Operator | 'directions';
  exposure: number; // stops
  scale: Scale;
  isSigned: boolean;
}

/// Where the picture lies on the canvas, in its pixels from the top left corner.
export interface Placement {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

const operators = { linear: 0, filmic: 1, reinhard: 2, falsecolor: 3, directions: 4 };
const uniformNames = ['rectangle', 'picture', 'palette', 'scale', 'exposure', 'operator', 'limits'] as const;
type Uniforms = Record<(typeof uniformNames)[number], WebGLUniformLocation | null>;

/// Draws frames by WebGL2, with exposure and tone operator.
export class PictureCanvas {
  private readonly gl: WebGL2RenderingContext;
  private readonly uniforms: Uniforms;
  private readonly textures: { picture: WebGLTexture; palette: WebGLTexture; signed: WebGLTexture };
  private readonly filtersFloat: boolean;
  private frame: Frame | null = null;

  /// Throws where the browser has no WebGL2.
  constructor(private readonly canvas: HTMLCanvasElement) {
    const gl = canvas.getContext('webgl2', { alpha: true, antialias: false, depth: false });
    if (!gl) throw new Error('This browser has no WebGL2, which the picture needs.');
    this.gl = gl;
    const program = linked(gl, vertexShader, fragmentShader);
    gl.useProgram(program);
    const place = (name: string) => gl.getUniformLocation(program, name);
    this.uniforms = Object.fromEntries(uniformNames.map((name) => [name, place(name)])) as Uniforms;
    this.filtersFloat = gl.getExtension('OES_texture_float_linear') !== null;
    this.textures = {
      picture: gl.createTexture()!,
      palette: this.palette(false),
      signed: this.palette(true),
    };
    gl.uniform1i(this.uniforms.picture, 0);
    gl.uniform1i(this.uniforms.palette, 1);
  }

  show(frame: Frame): void {
    const { gl } = this;
    this.frame = frame;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.textures.picture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
    const { width, height, pixels } = frame;
    if (pixels instanceof Uint32Array)
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB9_E5, width, height, 0, gl.RGB, gl.UNSIGNED_INT_5_9_9_9_REV, pixels);
    else gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB32F, width, height, 0, gl.RGB, gl.FLOAT, pixels);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T])
      gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
  }

  draw(look: Look, at: Placement): void {
    const { gl, uniforms, canvas, frame } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (!frame) return;
    this.bind(look, at, frame);
    const x = (pixel: number) => (2 * pixel) / canvas.width - 1;
    const y = (pixel: number) => 1 - (2 * pixel) / canvas.height;
    gl.uniform4f(uniforms.rectangle, x(at.left), y(at.top), x(at.right), y(at.bottom));
    gl.uniform1f(uniforms.scale, frame.scale);
    gl.uniform1f(uniforms.exposure, 2 ** look.exposure);
    gl.uniform1i(uniforms.operator, operators[look.operator]);
    const { minimum, maximum, isLogarithmic } = look.scale;
    gl.uniform3f(uniforms.limits, minimum, maximum, isLogarithmic ? 1 : 0);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  private bind(look: Look, at: Placement, frame: Frame): void {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, look.isSigned ? this.textures.signed : this.textures.palette);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.textures.picture);
    // Pixels have edges as soon as they are twice as large as the screen's; coarse previews are
    // blurred instead, since their squares say nothing.
    const enlarged = (at.right - at.left) / frame.width;
    const canFilter = frame.format === 'rgb9e5' || this.filtersFloat;
    const filter = canFilter && (enlarged < 2 || frame.kind === 'preview') ? gl.LINEAR : gl.NEAREST;
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  }

  private palette(isSigned: boolean): WebGLTexture {
    const { gl } = this;
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, paletteBytes(isSigned));
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T])
      gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
    return texture;
  }
}
