// SPDX-License-Identifier: GPL-2.0-or-later
// The theme starts navigation and search by scripts within the page. The server of the operator's screen
// allows no such scripts, so this file replaces them.
document.addEventListener('DOMContentLoaded', () => {
  if (typeof SphinxRtdTheme !== 'undefined') {
    SphinxRtdTheme.Navigation.enable(true);
  }
  const isLoading = document.querySelector('script[src$="searchindex.js"]') !== null;
  if (typeof Search !== 'undefined' && !isLoading) {
    Search.loadIndex('searchindex.js');
  }
});
