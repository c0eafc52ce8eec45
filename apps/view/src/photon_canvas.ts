import { linked } from './gl';
import type { PhotonClass } from './photon_cloud';
import type { Placement } from './picture';

const vertexShader = `#version 300 es
uniform vec4 rows[3];     // of the camera's matrix
uniform vec4 rectangle;   // of the picture, in clip coordinates: left, top, right, bottom
uniform vec2 size;        // of the picture, pixels
uniform float point_size;
in vec3 position;
in vec4 colour;           // invisible where its alpha is 0
out vec4 point_colour;
void main() {
  vec4 point = vec4(position, 1.0);
  float w = dot(rows[2], point);
  vec2 place = vec2(dot(rows[0], point), dot(rows[1], point)) / (w * size);
  bool is_seen = w > 0.0 && colour.a > 0.0;
  gl_Position = is_seen ? vec4(mix(rectangle.xy, rectangle.zw, place), 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = point_size;
  point_colour = colour;
}`;

const fragmentShader = `#version 300 es
precision highp float;
uniform float point_size;
in vec4 point_colour;
out vec4 shown;
void main() {
  float distance = length(gl_PointCoord - 0.5) * point_size;
  float cover = clamp(0.5 * point_size - distance + 0.5, 0.0, 1.0) * point_colour.a;
  shown = vec4(point_colour.rgb * cover, cover);
}`;

/// Draws points of the scene over the picture, by WebGL2: one program and two buffers, for which a
/// library of scenes would be much to load.
export class PhotonCanvas {
  private readonly gl: WebGL2RenderingContext;
  private readonly place: (name: string) => WebGLUniformLocation | null;
  private readonly positions: WebGLBuffer;
  private readonly colours: WebGLBuffer;
  private count = 0;

  /// Throws where the browser has no WebGL2.
  constructor(private readonly canvas: HTMLCanvasElement) {
    const gl = canvas.getContext('webgl2', { alpha: true, antialias: false, depth: false });
    if (!gl) throw new Error('This browser has no WebGL2, which photons need.');
    this.gl = gl;
    const program = linked(gl, vertexShader, fragmentShader);
    gl.useProgram(program);
    this.place = (name) => gl.getUniformLocation(program, name);
    const buffer = (name: string, components: number, type: number) => {
      const made = gl.createBuffer()!;
      const at = gl.getAttribLocation(program, name);
      gl.bindBuffer(gl.ARRAY_BUFFER, made);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, components, type, type === gl.UNSIGNED_BYTE, 0, 0);
      return made;
    };
    this.positions = buffer('position', 3, gl.FLOAT);
    this.colours = buffer('colour', 4, gl.UNSIGNED_BYTE);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.SCISSOR_TEST);
  }

  setPositions(positions: Float32Array): void {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.positions);
    gl.bufferData(gl.ARRAY_BUFFER, positions, gl.STATIC_DRAW);
    this.count = positions.length / 3;
  }

  /// The colour of each point is that of its class; classes that are hidden are not drawn.
  setClasses(classes: PhotonClass[], classOf: (point: number) => number, hidden: ReadonlySet<number>): void {
    const { gl, count } = this;
    const bytes = new Uint8Array(4 * count);
    for (let i = 0; i < count; ++i) {
      const index = classOf(i);
      bytes.set(classes[index]!.colour, 4 * i);
      bytes[4 * i + 3] = hidden.has(index) ? 0 : 217;
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.colours);
    gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.STATIC_DRAW);
  }

  clear(): void {
    const { gl, canvas } = this;
    gl.scissor(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  /// `projection`: 3 rows of 4 numbers, from the world to the picture's pixels, of which there are
  /// `width` × `height`. `pointSize`: in the canvas's pixels.
  draw(projection: readonly number[], { width, height }: { width: number; height: number }, at: Placement, pointSize: number): void {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    this.clear();
    const x = (pixel: number) => (2 * pixel) / canvas.width - 1;
    const y = (pixel: number) => 1 - (2 * pixel) / canvas.height;
    gl.scissor(Math.floor(at.left), Math.floor(canvas.height - at.bottom), Math.max(0, Math.ceil(at.right - at.left)), Math.max(0, Math.ceil(at.bottom - at.top)));
    gl.uniform4fv(this.place('rows'), projection);
    gl.uniform4f(this.place('rectangle'), x(at.left), y(at.top), x(at.right), y(at.bottom));
    gl.uniform2f(this.place('size'), width, height);
    gl.uniform1f(this.place('point_size'), pointSize);
    gl.drawArrays(gl.POINTS, 0, this.count);
  }
}
