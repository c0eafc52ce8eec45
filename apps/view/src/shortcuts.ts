import type { CameraControl } from './camera_control';
import type { Display } from './display';
import type { Hint, Shortcut } from './keyboard';
import type { Operator } from './layers';
import type { Photons } from './photons';
import type { Probe } from './probe';
import type { Refine } from './refine';
import type { Region } from './region';
import type { SaveDialog } from './save';
import { switchTheme } from './theme';
import { chooseTool, type Tool, tool } from './tools';
import type { Transport } from './transport';
import type { View } from './view';

interface Parts {
  camera: CameraControl;
  display: Display;
  photons: Photons;
  probe: Probe;
  refine: Refine;
  region: Region;
  save: SaveDialog;
  transport: Transport;
  view: View;
  showHelp(): void;
}

const turn = Math.PI / 36;

/// Arrows do with the chosen tool what a drag does.
function moveByArrow(parts: Parts, event: KeyboardEvent): void {
  const along: Record<string, [number, number]> = {
    ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1],
  };
  const [x, y] = along[event.key] ?? [0, 0];
  const far = event.shiftKey ? 4 : 1;
  if (tool.value === 'camera') {
    if (event.shiftKey) parts.camera.pan(x * 0.04, -y * 0.04);
    else parts.camera.orbit(x * turn, -y * turn);
  } else if (tool.value === 'picture') parts.view.pan(-x * 40 * far, -y * 40 * far);
  else parts.probe.step(x * far, y * far);
}

export function shortcuts(parts: Parts): Shortcut[] {
  const { display, view, camera } = parts;
  const pick = (name: Tool) => () => chooseTool(name);
  const operator = (name: Operator) => () => display.setOperator(name);
  return [
    { group: 'Render', keys: [' '], shown: 'Space', text: 'Start, pause, resume', run: () => parts.transport.toggle() },
    { group: 'Render', keys: ['s'], shown: 'S', text: 'Save the picture', run: () => parts.save.open() },
    { group: 'Render', keys: ['m'], shown: 'M', text: 'More samples in the region', run: () => void parts.refine.ask() },
    { group: 'Tools', keys: ['c'], shown: 'C', text: 'Camera: drag to orbit', run: pick('camera') },
    { group: 'Tools', keys: ['v'], shown: 'V', text: 'Picture: drag to pan, wheel to zoom', run: pick('picture') },
    { group: 'Tools', keys: ['p'], shown: 'P', text: 'Probe: drag over pixels', run: pick('probe') },
    { group: 'Tools', keys: ['r'], shown: 'R', text: 'Region: drag a rectangle', run: pick('region') },
    {
      group: 'Tools', keys: ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'], shown: 'Arrows',
      text: 'Orbit, pan or move the probe, as the tool says', run: (event) => moveByArrow(parts, event),
    },
    {
      group: 'Tools', keys: ['Escape'], shown: 'Esc', text: 'Let go of the pixel and the region',
      run: () => {
        parts.probe.pinned.value = null;
        parts.region.clear();
      },
    },
    { group: 'Camera', keys: ['h'], shown: 'H', text: 'Back to where the camera was at first', run: () => camera.goHome() },
    { group: 'Camera', keys: ['['], shown: '[', text: 'Nearer', run: () => camera.dolly(1 / 1.1) },
    { group: 'Camera', keys: [']'], shown: ']', text: 'Farther', run: () => camera.dolly(1.1) },
    { group: 'Picture', keys: ['f'], shown: 'F', text: 'Fit the picture', run: () => view.fit() },
    { group: 'Picture', keys: ['z'], shown: 'Z', text: 'One pixel for one of the screen', run: () => view.zoomTo(1 / (window.devicePixelRatio || 1)) },
    { group: 'Picture', keys: ['+', '='], shown: '+', text: 'Larger', run: () => view.zoomBy(1.5) },
    { group: 'Picture', keys: ['-'], shown: '−', text: 'Smaller', run: () => view.zoomBy(1 / 1.5) },
    { group: 'Picture', keys: ['x'], shown: 'X', text: 'Photons over the picture', run: () => parts.photons.toggle() },
    { group: 'Picture', keys: ['l'], shown: 'L', text: 'Next layer', run: () => display.nextLayer(1) },
    { group: 'Picture', keys: ['Shift+l'], shown: 'Shift L', text: 'Layer before', run: () => display.nextLayer(-1) },
    { group: 'Tone', keys: ['e'], shown: 'E', text: 'Half a stop brighter', run: () => display.exposeBy(0.5) },
    { group: 'Tone', keys: ['Shift+e'], shown: 'Shift E', text: 'Half a stop darker', run: () => display.exposeBy(-0.5) },
    { group: 'Tone', keys: ['a'], shown: 'A', text: 'Exposure by itself', run: () => display.exposeByItself() },
    { group: 'Tone', keys: ['0'], shown: '0', text: 'Exposure 0', run: () => display.setExposure(0) },
    { group: 'Tone', keys: ['1'], shown: '1', text: 'Linear', run: operator('linear') },
    { group: 'Tone', keys: ['2'], shown: '2', text: 'Filmic', run: operator('filmic') },
    { group: 'Tone', keys: ['3'], shown: '3', text: 'Reinhard', run: operator('reinhard') },
    { group: 'Tone', keys: ['4'], shown: '4', text: 'False colours', run: operator('falsecolor') },
    { group: 'Page', keys: ['t'], shown: 'T', text: 'Dark or light', run: switchTheme },
    { group: 'Page', keys: ['?'], shown: '?', text: 'This help', run: parts.showHelp },
  ];
}

/// What mouse and fingers do.
export const hints: Hint[] = [
  { group: 'Mouse and fingers', shown: 'Wheel', text: 'Nearer or farther; with other tools: zoom' },
  { group: 'Mouse and fingers', shown: 'Ctrl + wheel', text: 'Zoom into the picture' },
  { group: 'Mouse and fingers', shown: 'Shift + wheel', text: 'Exposure' },
  { group: 'Mouse and fingers', shown: 'Alt + wheel', text: 'Angle of view' },
  { group: 'Mouse and fingers', shown: 'Shift + drag', text: 'Move the camera sideways (or right button)' },
  { group: 'Mouse and fingers', shown: 'Click', text: 'Hold the probe at a pixel' },
  { group: 'Mouse and fingers', shown: 'Two fingers', text: 'Nearer and sideways; with other tools: zoom' },
];
