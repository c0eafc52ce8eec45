/// What the page and the server say to each other. All addresses are relative, so that the page
/// also works behind a proxy that gives it a folder of its own.

export type Vec3 = [number, number, number];

export interface Camera {
  origin: Vec3;
  target: Vec3;
  up: Vec3;
  fov: number | null; // degrees; null: this camera has none
}

export type RenderState = 'idle' | 'building' | 'rendering' | 'paused' | 'finished' | 'failed';

export interface State {
  program: string;
  scene: string;
  revision: number;
  state: RenderState;
  failure: string | null;
  refusal: { revision: number; text: string } | null;
  width: number;
  height: number;
  passes: number;
  samples: number;
  elapsed_s: number;
  error: number | null; // of the picture, relative
  is_moving: boolean;
  regions: RefinedRegion[];
  integrator: string;
  layers: string[];
  unit: string;
  camera: Camera;
  can_edit: boolean; // false: a program renders the scene, and only it can change it
}

export interface LogLine {
  level: 'info' | 'warning' | 'error';
  text: string;
}

export interface ErrorHistory {
  elapsed_s: number[];
  error: number[];
}

export interface Pixel {
  x: number;
  y: number;
  value: Vec3;
  luminance: number;
  standard_error: number | null;
  interval: [number, number] | null; // of the luminance, 95 %
  bias: number[] | null;
  layers: Record<string, number[]>;
  passes: number;
}

export interface RegionMean {
  mean: number; // luminance
  standard_error: number | null;
  interval: [number, number] | null;
  pixels: number;
}

export interface Rectangle {
  x: number;
  y: number;
  width: number;
  height: number;
}

/// A region that has passes of its own, or is to have some.
export interface RefinedRegion extends Rectangle {
  passes: number;
  waiting: number;
}

export type ParameterValue = number | boolean | string | number[] | null;

export interface Parameter {
  name: string;
  kind: 'number' | 'integer' | 'boolean' | 'choice' | 'color' | 'text';
  value: ParameterValue;
  default?: ParameterValue;
  minimum?: number | null;
  maximum?: number | null;
  unit?: string | null;
  choices?: string[] | null;
  about?: string | null;
}

export interface SceneObject {
  id: string;
  family: string;
  type: string;
  parameters: Parameter[];
}

export interface Parameters {
  objects: SceneObject[];
  integrators: string[];
}

export type Action = 'start' | 'pause' | 'resume' | 'stop' | 'reset';

export type Command =
  | { camera: Camera }
  | { set: Record<string, ParameterValue> }
  | { integrator: string }
  | { do: Action }
  | { refine: Rectangle & { passes: number } }
  | { save: { name: string } };

export interface CommandAnswer {
  revision?: number;
  file?: string;
}

export type FrameFormat = 'rgb9e5' | 'f32';

export interface FrameRequest {
  after: number;
  layer: string;
  format: FrameFormat;
  width: number | null; // null: all pixels
}

/// The server's "no", with its remedy.
export class Refusal extends Error {
  constructor(
    readonly status: number,
    message: string,
    readonly remedy: string,
  ) {
    super(message);
  }
}

/// True where a new token is needed.
export function isLockedOut(error: unknown): boolean {
  return error instanceof Refusal && (error.status === 401 || error.status === 403);
}

export class Client {
  async login(token: string): Promise<void> {
    await this.ask('session', this.posted({ token }));
  }

  async state(): Promise<State> {
    return (await this.ask('state')).json();
  }

  async parameters(): Promise<Parameters> {
    return (await this.ask('parameters')).json();
  }

  async pixel(x: number, y: number): Promise<Pixel> {
    return (await this.ask(`pixel?${query({ x, y })}`)).json();
  }

  async region(region: Rectangle): Promise<RegionMean> {
    return (await this.ask(`region?${query({ ...region })}`)).json();
  }

  /// Some of the scene's photons, for PhotonCloud; null: those of the key are what there is.
  async photons(most: number, known: string | null): Promise<Response | null> {
    const response = await this.ask(`photons?${query({ max: most, ...(known ? { known } : {}) })}`);
    return response.status === 204 ? null : response;
  }

  async command(command: Command): Promise<CommandAnswer> {
    return (await this.ask('command', this.posted(command))).json();
  }

  /// Waits for a newer picture; null if there was none for a while.
  async frame(request: FrameRequest, signal: AbortSignal): Promise<Response | null> {
    const { after, layer, format, width } = request;
    const asked = { after, layer, format, ...(width === null ? {} : { width }) };
    const response = await this.ask(`frame?${query(asked)}`, { signal });
    return response.status === 204 ? null : response;
  }

  events(): EventSource {
    return new EventSource('events');
  }

  private posted(body: unknown): RequestInit {
    return {
      method: 'POST',
      headers: { 'Content-Type': 'application/json' },
      body: JSON.stringify(body),
    };
  }

  private async ask(address: string, init: RequestInit = {}): Promise<Response> {
    const response = await fetch(address, { cache: 'no-store', credentials: 'same-origin', ...init });
    if (response.ok) return response;
    throw await refusal(response);
  }
}

async function refusal(response: Response): Promise<Refusal> {
  let text = `The server answered ${response.status}.`;
  let remedy = '';
  try {
    const told = (await response.json()) as { error?: string; remedy?: string };
    text = told.error ?? text;
    remedy = told.remedy ?? '';
  } catch {
    // It told nothing more.
  }
  return new Refusal(response.status, text, remedy);
}

function query(values: Record<string, string | number>): string {
  return new URLSearchParams(Object.entries(values).map(([k, v]) => [k, String(v)])).toString();
}
