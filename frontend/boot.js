// Starts the page. In a file of its own: the content security policy allows no script inside the document.
import init from "./page.js";

// Before anything is drawn: the colours that somebody has chosen (src/theme.rs).
try {
  const theme = localStorage.getItem("cipdeck.theme");
  if (theme) document.documentElement.dataset.theme = theme;
} catch {
  // No storage, no choice.
}

const note = document.getElementById("boot");
try {
  await init({ module_or_path: new URL("./page.wasm", import.meta.url) });
  note.remove();
} catch (error) {
  note.setAttribute("role", "alert");
  note.textContent = `cipdeck could not start: ${error}. A current browser with WebAssembly is needed; reload to try again.`;
  throw error;
}
