import type { CameraControl } from './camera_control';
import { distanceOf, fovRange } from './camera';
import { byId, setText } from './dom';
import { formatNumber } from './numbers';

/// Where the camera is, in numbers, and its angle.
export function startCameraPanel(control: CameraControl): void {
  const slider = byId<HTMLInputElement>('fov');
  slider.min = String(fovRange.minimum);
  slider.max = String(fovRange.maximum);
  slider.addEventListener('input', () => control.setFov(Number(slider.value)));
  byId('home').addEventListener('click', () => control.goHome());
  control.camera.watch((camera) => {
    if (!camera) return;
    const text = (v: readonly number[]) => v.map((x) => formatNumber(x, 4)).join(', ');
    setText(byId('camera-origin'), text(camera.origin));
    setText(byId('camera-target'), text(camera.target));
    setText(byId('camera-distance'), formatNumber(distanceOf(camera)));
    byId('fov-row').hidden = camera.fov === null;
    if (camera.fov === null) return;
    slider.value = String(camera.fov);
    slider.setAttribute('aria-valuetext', `${formatNumber(camera.fov, 3)} degrees`);
    setText(byId('fov-value'), `${camera.fov.toFixed(1)}°`);
  });
}
