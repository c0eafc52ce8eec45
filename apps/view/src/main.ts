/// The page of `kaustik view`: makes its parts and connects them.

import { Client, Refusal } from './protocol';
import { CameraControl } from './camera_control';
import { startCameraPanel } from './camera_panel';
import { Connection } from './connection';
import { Display } from './display';
import { byId, setText } from './dom';
import { FrameLoop } from './frame_loop';
import { Gestures } from './gestures';
import { Keyboard } from './keyboard';
import { Legend } from './legend';
import { Log } from './log';
import { startNotice } from './notice';
import { ParametersPanel } from './parameters';
import { Photons } from './photons';
import { ErrorPlot } from './plot';
import { Probe } from './probe';
import { startReadOnly } from './read_only';
import { Refine } from './refine';
import { Region } from './region';
import { SaveDialog } from './save';
import { hints, shortcuts } from './shortcuts';
import { Stage } from './stage';
import { Tabs } from './tabs';
import { startTheme, switchTheme } from './theme';
import { toast } from './toast';
import { startTools } from './tools';
import { Transport } from './transport';
import { photometry } from './units';
import { View } from './view';

function start(): void {
  const client = new Client();
  const connection = new Connection(client);
  const { state } = connection;
  const tabs: Tabs = new Tabs((name) => name === 'tab-log' && log.read());
  const log = new Log(() => tabs.chosen === 'tab-log');
  connection.log.onChange((line) => line && log.add(line));

  const fail = (error: unknown) => {
    connection.suspect(error);
    if (!(error instanceof Refusal) || error.status === 403) return;
    // Somebody asks for what is not there yet: the next frame asks again.
    if (error.status === 409) return;
    const text = [error.message, error.remedy].filter(Boolean).join(' – ');
    log.add({ level: 'error', text });
    toast(text, 'error');
  };

  const frames = new FrameLoop(client, (error) => {
    fail(error);
    // A layer that is no more: the picture is there always.
    if (error instanceof Refusal && error.status !== 403) display.setLayers(['']);
  });
  const display = new Display();
  const view = new View();
  const camera = new CameraControl(client, fail);
  const probe = new Probe(client, state, fail);
  const region = new Region(client, state, fail);
  const refine = new Refine(client, state, region.rectangle, (error) => {
    fail(error);
    // What the button promised, and could not do.
    if (error instanceof Refusal && error.status === 409) toast(error.message, 'error');
  });
  const photons = new Photons(client, state, fail);
  const parameters = new ParametersPanel(client, fail);
  const transport = new Transport(client, state, fail);
  const save = new SaveDialog(client, (file) => {
    log.add({ level: 'info', text: `Saved ${file}` });
    toast(`Saved ${file}`);
  }, fail);
  const plot = new ErrorPlot(connection.history);
  const legend = new Legend(display, state);
  const stage = byId('stage');

  let revision = -1;
  state.onChange((now) => {
    if (!now) return;
    document.title = `${now.scene} · Kaustik`;
    setText(byId('scene-name'), now.scene);
    setText(byId('program-version'), now.program);
    display.setLayers(now.layers);
    camera.follow(now);
    if (now.revision !== revision && !now.is_moving) parameters.readSoon(revision === -1 ? 0 : undefined);
    revision = now.is_moving ? revision : now.revision;
  });
  connection.status.onChange((status) => {
    if (status !== 'connected') return;
    frames.restart();
    parameters.readSoon(0);
  });
  frames.frame.onChange(() => {
    probe.refresh();
    region.refresh();
  });

  startTheme(() => {
    plot.refresh();
    legend.draw();
  });
  byId('theme').addEventListener('click', switchTheme);
  for (const button of document.querySelectorAll<HTMLButtonElement>('.photometry button'))
    button.addEventListener('click', () => (photometry.value = button.value === 'photometric' ? 'photometric' : 'radiometric'));
  photometry.watch((now) => {
    for (const button of document.querySelectorAll<HTMLButtonElement>('.photometry button'))
      button.setAttribute('aria-pressed', String(button.value === now));
  });
  startTools(stage);
  startReadOnly(state);
  startNotice(connection);
  startCameraPanel(camera);
  try {
    new Stage(connection, frames, display, view, probe, region, photons);
  } catch (error) {
    log.add({ level: 'error', text: (error as Error).message });
    toast((error as Error).message, 'error');
  }
  new Gestures(stage, view, camera, display, {
    hover: (pixel) => (probe.hovered.value = pixel),
    pin: (pixel) => {
      probe.pin(pixel);
      if (tabs.chosen === 'tab-log') tabs.choose('tab-measure');
    },
    drawRegion: (from, to, isDone) => {
      region.draw(from, to, isDone);
      if (!isDone) return;
      tabs.choose('tab-measure');
      byId('region-end').scrollIntoView({ block: 'nearest' });
    },
  });
  const keyboard: Keyboard = new Keyboard(
    shortcuts({ camera, display, photons, probe, refine, region, save, transport, view, showHelp: () => keyboard.toggleHelp() }),
    hints,
  );
  void connection.open();
}

start();
